// SPDX-License-Identifier: BSD-3-Clause
#include "core/files/yaml_document.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "tests/support/temporary_folder.hpp"

namespace aims {
namespace {

class YamlPosition : public ::testing::Test {
 protected:
  std::filesystem::path write(const char* name, const char* text) const {
    std::ofstream(folder_.path() / name) << text;
    return folder_.path() / name;
  }
  TemporaryFolder folder_;
};

TEST_F(YamlPosition, NamesTheValueOfTheKey) {
  const auto file = write("a.yaml", "seed: 1\nroute:\n  points:\n    - {x: 0}\n    - {x: 3}\n");
  EXPECT_EQ(with_position(file, "route.points.1.x: too far"),
            file.string() + ":5:11: route.points.1.x: too far");
}

TEST_F(YamlPosition, FallsBackToTheNearestGroupAround) {
  const auto file = write("a.yaml", "route:\n  speed: 1\n");
  EXPECT_EQ(with_position(file, "route.points: too few"),
            file.string() + ":2:3: route.points: too few");
}

TEST_F(YamlPosition, LooksIntoTheBase) {
  const auto base = write("base.yaml", "route:\n  points: [{x: 0}]\n");
  const auto file = write("a.yaml", "base: base.yaml\nseed: 2\n");
  EXPECT_EQ(with_position(file, "route.points.0: in a wall"),
            base.string() + ":2:12: route.points.0: in a wall");
}

TEST_F(YamlPosition, NamesTheFileAloneWhenTheKeyIsNowhere) {
  const auto file = write("a.yaml", "seed: 1\n");
  EXPECT_EQ(with_position(file, "route: nowhere to go"), file.string() + ": route: nowhere to go");
  EXPECT_EQ(with_position("gone.yaml", "route: x"), "gone.yaml: route: x");
}

}  // namespace
}  // namespace aims
