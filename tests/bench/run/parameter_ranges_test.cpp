// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "bench/estimate/estimate.hpp"
#include "bench/scenario/scenario.hpp"
#include "core/files/config_dump.hpp"
#include "core/files/yaml_config.hpp"
#include "estimator/registry.hpp"
#include "tests/support/parameter_bounds.hpp"

namespace aims {
namespace {

using testing::is_numeric;

/// Every key that a scenario can have: with every estimator, a limit, and every switch on.
Scenario full_scenario() {
  Scenario scenario;
  scenario.run = estimator_names();
  scenario.expect.push_back({"aims", "ate_m", 1.0, -1.0});
  scenario.draw.resize(1);
  scenario.simulation.scene.corridor.bends.resize(1);
  for (const Parameter& parameter : fields_of(scenario).parameters()) {
    if (parameter.kind == ParameterKind::kFlag) parameter.assign("true");
  }
  return scenario;
}

/// The text of one value, or of a vector of it.
std::string text_for(const Parameter& parameter, const std::string& value) {
  if (!is_sequence(parameter)) return value;
  const bool three = parameter.expected.starts_with("three");
  return three ? fmt::format("[{0}, {0}, {0}]", value) : fmt::format("[{0}, {0}]", value);
}

/// An allowed value at or next to the end of the range.
std::string lowest(const Parameter& parameter) {
  const Range& range = parameter.spec.range;
  return fmt::format("{}", range.min_included ? range.min : std::nextafter(range.min, 1e300));
}
std::string highest(const Parameter& parameter) {
  const Range& range = parameter.spec.range;
  return fmt::format("{}", range.max_included ? range.max : std::nextafter(range.max, -1e300));
}

/// Values that are beyond a range or no numbers at all.
std::vector<std::string> refused_values(const Parameter& parameter) {
  const Range& range = parameter.spec.range;
  const bool whole = parameter.kind == ParameterKind::kInteger;
  const double below = whole ? range.min - 1.0 : std::nextafter(range.min, -1e300);
  const double above = whole ? range.max + 1.0 : std::nextafter(range.max, 1e300);
  return {fmt::format("{}", below),
          fmt::format("{}", above),
          "1e308",
          "-1e308",
          "9.3e18",
          "inf",
          "-inf",
          "nan",
          "",
          "x",
          "1e400"};
}

void expect_refused(const Fields& fields, const Parameter& parameter, const std::string& value) {
  const std::string before = parameter.text();
  const auto assigned = assign(fields, parameter.key, text_for(parameter, value));
  ASSERT_FALSE(assigned.has_value()) << parameter.key << " = " << value;
  EXPECT_NE(assigned.error().message.find(parameter.key), std::string::npos)
      << assigned.error().message;
  EXPECT_EQ(parameter.text(), before) << parameter.key << " = " << value;
}

TEST(ParameterRanges, EveryNumberOfAScenarioAndOfAnEstimateHasTwoFiniteBounds) {
  Scenario scenario = full_scenario();
  testing::expect_bounded(fields_of(scenario));
  EstimateConfig estimate;
  estimate.run = estimator_names();
  testing::expect_bounded(fields_of(estimate));
}

TEST(ParameterRanges, NoNumberTakesWhatIsBeyondItsRangeOrNoNumber) {
  Scenario scenario = full_scenario();
  const Fields fields = fields_of(scenario);
  for (const Parameter& parameter : fields.parameters()) {
    if (!is_numeric(parameter)) continue;
    for (const std::string& value : refused_values(parameter)) {
      expect_refused(fields, parameter, value);
    }
  }
}

TEST(ParameterRanges, SmallAndOddValuesAreTakenExactlyWithinTheRange) {
  Scenario scenario = full_scenario();
  const Fields fields = fields_of(scenario);
  for (const Parameter& parameter : fields.parameters()) {
    if (!is_numeric(parameter)) continue;
    for (const double value : {0.0, -1.0, 1e-308, 2147483648.0}) {
      const bool whole = parameter.kind != ParameterKind::kInteger || std::floor(value) == value;
      const bool taken =
          assign(fields, parameter.key, text_for(parameter, fmt::format("{}", value))).has_value();
      EXPECT_EQ(taken, whole && parameter.spec.range.contains(value)) << parameter.key << value;
    }
  }
}

/// Every number of a scenario at one end of its range, written and read again.
void expect_round_trip(std::string (*end)(const Parameter&)) {
  Scenario scenario = full_scenario();
  const Fields fields = fields_of(scenario);
  for (const Parameter& parameter : fields.parameters()) {
    if (!is_numeric(parameter)) continue;
    const auto assigned = assign(fields, parameter.key, text_for(parameter, end(parameter)));
    EXPECT_TRUE(assigned.has_value()) << parameter.key << " = " << end(parameter);
  }
  Scenario again = full_scenario();
  const auto loaded = load_config_text(dump_config(fields_of(scenario)), "extremes.yaml", again);
  ASSERT_TRUE(loaded.has_value()) << loaded.error().message;
  const Fields read = fields_of(again);
  for (const Parameter& parameter : fields_of(scenario).parameters()) {
    if (!parameter.idle.empty()) continue;
    ASSERT_NE(read.find(parameter.key), nullptr) << parameter.key;
    EXPECT_EQ(read.find(parameter.key)->text(), parameter.text()) << parameter.key;
  }
}

TEST(ParameterRanges, BothEndsOfEveryRangeAreTakenAndReadBack) {
  expect_round_trip(lowest);
  expect_round_trip(highest);
}

}  // namespace
}  // namespace aims
