// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/config.hpp"
#include "core/error.hpp"

namespace aims {

/// What a listing shows of a scenario; members as those of `Scenario`.
struct ScenarioHead {
  std::string name;
  std::string description;
  std::vector<std::string> tags;
  std::string family;
  double level = 0.0;
  std::string level_unit;
};

/// Fields that a scenario and its head share.
template <class Head>
void describe_head(Fields& f, Head& h) {
  f.text("name", h.name, {.meaning = "name of the scenario; the file's name when absent"});
  f.text("description", h.description, {.meaning = "one line for listings"});
  f.texts("tags", h.tags, {.meaning = "sets that the scenario belongs to, for --tags"});
  f.text("family", h.family, {.meaning = "scenarios that differ in one quantity; empty: none"});
  f.number(
      "level", h.level,
      {.unit = "level_unit", .range = within(1e9), .meaning = "that quantity in this scenario"});
  f.text("level_unit", h.level_unit, {.meaning = "unit of the level"});
}

/// Reads the head of a scenario's file and of its bases, and nothing else, so that what is wrong
/// elsewhere goes unnoticed. `folder` as of `load_scenario`.
Result<ScenarioHead> load_scenario_head(const std::filesystem::path& file,
                                        const std::filesystem::path& folder);

}  // namespace aims
