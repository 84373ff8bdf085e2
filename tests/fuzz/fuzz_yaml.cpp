// SPDX-License-Identifier: BSD-3-Clause
#include <cstdlib>
#include <sstream>
#include <string>
#include <vector>

#include "bench/estimate/estimate.hpp"
#include "bench/scenario/scenario.hpp"
#include "bench/tuning/sweep_plan.hpp"
#include "bench/tuning/tune_plan.hpp"
#include "core/files/yaml_config.hpp"
#include "tests/fuzz/demand.hpp"
#include "tests/fuzz/fuzz_targets.hpp"
#include "tests/fuzz/memory_file.hpp"

namespace aims {
namespace {

constexpr std::string_view kSet = "--set ";

/// What was loaded is written as text that loads to the same.
void write_again(const Scenario& scenario) {
  const std::string text = config_text(scenario);
  Scenario again;
  again.name = scenario.name;
  demand(load_config_text(text, "again.yaml", again).has_value());
  demand(config_text(again) == text);
}

void take_scenario(const Result<Scenario>& scenario) {
  if (scenario) {
    write_again(*scenario);
  } else {
    demand_readable(scenario.error());
  }
}

/// The settings of `text`, a line each; without files of settings, which could be any.
std::vector<std::string> settings_in(const std::string& text) {
  std::vector<std::string> settings;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with(kSet)) line.erase(0, kSet.size());
    if (!line.starts_with('@')) settings.push_back(line);
  }
  return settings;
}

void set_in_turn(const std::string& text) {
  const auto settings = settings_in(text);
  take_scenario(default_scenario(settings));
  const auto estimate = load_estimate_config({}, settings);
  if (!estimate) demand_readable(estimate.error());
}

}  // namespace

void fuzz_yaml(std::span<const std::uint8_t> input) {
  ::setenv("AIMS_PYTHON", "/bin/false", 1);  // `run: [python:...]` would import any module
  const std::string text(text_of(input));
  if (text.starts_with(kSet)) return set_in_turn(text);
  const MemoryFile file(std::as_bytes(input));
  take_scenario(load_scenario(file.path(), {}));
  const auto estimate = load_estimate_config(file.path(), {});
  if (!estimate) demand_readable(estimate.error());
  const auto sweep = load_plan(file.path());
  if (!sweep) demand_readable(sweep.error());
  const auto tune = load_tune_plan(file.path());
  if (!tune) demand_readable(tune.error());
}

}  // namespace aims
