// SPDX-License-Identifier: BSD-3-Clause
#include "core/files/yaml_config.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "core/files/atomic_file.hpp"
#include "core/files/config_dump.hpp"
#include "tests/core/files/sample_config.hpp"
#include "tests/support/temporary_folder.hpp"

namespace aims {
namespace {

using namespace testing;

TEST(Overrides, SetValuesInOrder) {
  Sample c;
  const std::vector<std::string> settings = {"inner.eta=1", "inner.eta=2.5", "points.0.name=a=b",
                                             "gravity=[0, 0, -1]", "name="};
  const auto applied = apply_overrides(c, settings);
  ASSERT_TRUE(applied) << applied.error().message;
  EXPECT_EQ(c.inner.eta, 2.5);
  EXPECT_EQ(c.points[0].name, "a=b");
  EXPECT_EQ(c.gravity.z(), -1.0);
  EXPECT_EQ(c.name, "");
}

TEST(Overrides, FilesGoOnTopInOrder) {
  const TemporaryFolder directory;
  const auto file = directory.path() / "tuned.yaml";
  ASSERT_TRUE(
      write_file_atomically(file, "inner: {eta: 4}\npoints:\n  - {name: x}\n  - {name: y}\n"));
  Sample c;
  const std::vector<std::string> settings = {"inner.eta=1", fmt::format("@{}", file.string()),
                                             "inner.count=7", "points.1.name=z"};
  const auto applied = apply_overrides(c, settings);
  ASSERT_TRUE(applied) << applied.error().message;
  EXPECT_EQ(c.inner.eta, 4.0);
  EXPECT_EQ(c.inner.count, 7);
  ASSERT_EQ(c.points.size(), 2U);
  EXPECT_EQ(c.points[1].name, "z");
  const auto missing = apply_overrides(c, std::vector<std::string>{"@gone.yaml"});
  ASSERT_FALSE(missing);
  EXPECT_NE(missing.error().message.find("gone.yaml"), std::string::npos);
}

TEST(Overrides, AListIsReplacedByItsYamlForm) {
  Sample c;
  const std::vector<std::string> settings = {"points=[[a, [0, 0], []], {name: b}, {name: c}]",
                                             "points.2.name=d"};
  std::vector<AssignedKey> assigned;
  const auto applied = apply_overrides(c, settings, &assigned);
  ASSERT_TRUE(applied) << applied.error().message;
  ASSERT_EQ(c.points.size(), 3U);
  EXPECT_EQ(c.points[0].name, "a");
  EXPECT_EQ(c.points[2].name, "d");
  ASSERT_FALSE(assigned.empty());
  EXPECT_EQ(assigned.front().key, "points.0.name");
  EXPECT_EQ(assigned.front().place, "--set " + settings[0] + ": ");
  Sample again;
  ASSERT_TRUE(load_config_text(dump_config(fields_of(c)), "dump.yaml", again));
  EXPECT_EQ(dump_config(fields_of(again)), dump_config(fields_of(c)));
  ASSERT_TRUE(apply_overrides(c, std::vector<std::string>{"points=[]"}));
  EXPECT_TRUE(c.points.empty());
}

TEST(Overrides, ErrorsNameTheEntryOfAList) {
  const auto message = [](const std::string& setting) {
    Sample c;
    return apply_overrides(c, std::vector<std::string>{setting}).error().message;
  };
  EXPECT_EQ(message("points=3"), "--set points=3: points: expected a list of maps, found '3'");
  EXPECT_EQ(
      message("points=[[a]]"),
      "--set points=[[a]]: points.0: expected a map or a list [name, position, tags], found 1 "
      "values");
  EXPECT_EQ(message("points=[{nam: a}]"),
            "--set points=[{nam: a}]: unknown key 'points.0.nam'; did you mean 'points.0.name'?");
  EXPECT_TRUE(message("points=[[a").starts_with("--set points=[[a:1:")) << message("points=[[a");
  EXPECT_EQ(message("points.4.name=a"),
            "--set points.4.name=a: points.4.name: no entry 4; points has 1, counted from 0");
}

TEST(Overrides, ErrorsNameTheSetting) {
  Sample c;
  const auto message = [&c](const std::string& setting) {
    return apply_overrides(c, std::vector<std::string>{setting}).error().message;
  };
  EXPECT_EQ(message("inner.eat=1"),
            "--set inner.eat=1: unknown key 'inner.eat'; did you mean 'inner.eta'?");
  EXPECT_EQ(message("inner.eta=x"),
            "--set inner.eta=x: inner.eta: 'x' is not a number in [0, 100]");
  EXPECT_EQ(message("inner.eta"), "--set inner.eta: expected key=value or @FILE");
  EXPECT_EQ(message("inner=1"),
            "--set inner=1: inner: a group of settings; expected one of its keys");
}

/// Two groups with the same keys.
struct Pair {
  Inner left;
  Inner right;
};

void describe(Fields& f, Pair& c) {
  f.group("left", c.left);
  f.group("right", c.right);
}

TEST(Wildcard, SetsTheKeyInEveryGroupThatHasIt) {
  Pair c;
  ASSERT_TRUE(load_config_text("\"*\": {eta: 7}\nleft: {count: 2}\n", "s.yaml", c));
  EXPECT_EQ(c.left.eta, 7.0);
  EXPECT_EQ(c.right.eta, 7.0);
  EXPECT_EQ(c.left.count, 2);
  ASSERT_TRUE(assign(fields_of(c), "*.model", "rolling"));
  EXPECT_EQ(c.right.model, Model::kRolling);
  const auto unknown = assign(fields_of(c), "*.etta", "7");
  ASSERT_FALSE(unknown);
  EXPECT_EQ(unknown.error().message, "unknown key '*.etta'; did you mean '*.eta'?");
}

TEST(CheckEffect, NamesPlaceKeyAndReasonWhateverTheOrder) {
  Pair c;
  std::vector<AssignedKey> assigned;
  const std::vector<std::string> settings = {"right.eta=4", "right.enabled=false"};
  ASSERT_TRUE(apply_overrides(c, settings, &assigned));
  const auto checked = check_effect(fields_of(c), assigned);
  ASSERT_FALSE(checked);
  EXPECT_EQ(checked.error().message,
            "--set right.eta=4: right.eta: has no effect: right.enabled is false");
  EXPECT_TRUE(check_effect(fields_of(c), std::vector<AssignedKey>{{"*.eta", ""}}));
  c.left.enabled = false;
  EXPECT_FALSE(check_effect(fields_of(c), std::vector<AssignedKey>{{"*.eta", ""}}));
}

}  // namespace
}  // namespace aims
