// SPDX-License-Identifier: BSD-3-Clause
#include "core/files/config_dump.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>
// rapidcheck's gtest glue needs both headers above it.
#include <rapidcheck/gtest.h>

#include <cmath>

#include "core/files/yaml_config.hpp"
#include "tests/core/files/sample_config.hpp"

namespace aims {
namespace {

using namespace testing;

TEST(DumpConfig, WritesNestedYaml) {
  Sample c;
  c.points.clear();
  EXPECT_EQ(dump_config(fields_of(c)),
            "name: corridor\n"
            "gravity: [0, 0, -9.81]\n"
            "estimators: [aims, lio]\n"
            "inner:\n"
            "  eta: 3\n"
            "  count: 5\n"
            "  enabled: true\n"
            "  model: point\n"
            "points: []\n");
}

TEST(DumpConfig, AnnotatedFormExplainsAndLoads) {
  Sample c;
  c.inner.eta = 1.25;
  const std::string text = dump_annotated_config(fields_of(c));
  EXPECT_NE(text.find("  eta: 1.25  # [-] a number in [0, 100]; Sensitivity.; eq. (8)\n"),
            std::string::npos)
      << text;
  Sample again;
  ASSERT_TRUE(load_config_text(text, "dump.yaml", again));
  EXPECT_EQ(again.inner.eta, 1.25);
}

TEST(DumpConfig, LeavesOutWhatHasNoEffect) {
  Sample c;
  c.points.clear();
  c.inner.enabled = false;
  const std::string text = dump_config(fields_of(c));
  EXPECT_NE(text.find("inner:\n  enabled: false\npoints"), std::string::npos) << text;
}

/// A list whose default is not that of its entries, behind a level.
struct Modes {
  int level = 0;
  std::vector<Inner> modes = {{.eta = 18.0}, {.eta = 35.0}};
};

void describe(Fields& f, Modes& c) {
  f.integer("level", c.level, {.range = in_range(0, 1), .meaning = "Level."});
  f.list("modes", c.modes, "Modes.");
  f.idle_if(c.level == 0, "level is 0", {"modes"});
}

TEST(DumpConfig, LeavesOutAListWithoutEffectSoThatItsDefaultStays) {
  Modes c;
  const std::string text = dump_config(fields_of(c));
  EXPECT_EQ(text, "level: 0\n");
  Modes again;
  ASSERT_TRUE(load_config_text(text, "dump.yaml", again));
  ASSERT_EQ(again.modes.size(), 2U);
  EXPECT_EQ(again.modes[1].eta, 35.0);
}

TEST(DumpConfig, WritesAListWithEffect) {
  Modes c;
  c.level = 1;
  c.modes.pop_back();
  Modes again;
  ASSERT_TRUE(load_config_text(dump_config(fields_of(c)), "dump.yaml", again));
  ASSERT_EQ(again.modes.size(), 1U);
  EXPECT_EQ(again.modes[0].eta, 18.0);
}

/// Texts of printable ASCII and a few control characters, with YAML's special ones frequent.
rc::Gen<std::string> awkward_text() {
  return rc::gen::container<std::string>(
      rc::gen::oneOf(rc::gen::inRange<char>(32, 127), rc::gen::element('\n', '\t', '\r', '\x01'),
                     rc::gen::element(':', '#', '"', '\'', '[', ',', '-', '~', '\\', ' ', '&')));
}

RC_GTEST_PROP(DumpConfig, IsReadBackToEqualValues, ()) {
  const auto number = rc::gen::suchThat(rc::gen::arbitrary<double>(),
                                        [](double each) { return std::isfinite(each); });
  Sample c;
  c.name = *awkward_text();
  c.estimators = *rc::gen::container<std::vector<std::string>>(awkward_text());
  c.gravity = {*number, *number, *number};
  c.inner.eta = std::fmod(std::abs(*number), 100.0);
  c.inner.count = *rc::gen::inRange(1, 10);
  c.inner.enabled = *rc::gen::arbitrary<bool>();
  c.inner.model = *rc::gen::element(Model::kPoint, Model::kRolling);
  c.points.resize(*rc::gen::inRange<std::size_t>(0, 4));
  for (Waypoint& each : c.points) each.name = *awkward_text();
  Sample again;
  const std::string text = dump_config(fields_of(c));
  const auto loaded = load_config_text(text, "dump.yaml", again);
  if (!loaded) RC_FAIL(loaded.error().message + "\n" + text);
  RC_ASSERT(again.name == c.name);
  RC_ASSERT(again.estimators == c.estimators);
  RC_ASSERT(again.gravity == c.gravity);
  RC_ASSERT(!c.inner.enabled || again.inner.eta == c.inner.eta);  // else it has no effect
  RC_ASSERT(again.points.size() == c.points.size());
  RC_ASSERT(dump_config(fields_of(again)) == text);
}

}  // namespace
}  // namespace aims
