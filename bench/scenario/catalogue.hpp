// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "bench/scenario/scenario.hpp"
#include "bench/scenario/scenario_head.hpp"
#include "core/error.hpp"

namespace aims {

/// One line of a listing.
struct CatalogueEntry {
  std::string name;
  std::string description;  ///< for a scenario whose head cannot be read: why
  std::vector<std::string> tags;
};

/// Scenarios that differ in one quantity.
struct Family {
  std::string name;
  std::string level_unit;
  std::vector<std::string> cases;  ///< names of the scenarios, by level
};

/// A scenario file and what it holds, or why it does not load.
struct ScenarioFile {
  std::filesystem::path file;
  Result<Scenario> scenario;
};

/// A scenario file and its head, or why that cannot be read.
struct ListedScenario {
  std::filesystem::path file;
  Result<ScenarioHead> head;
};

/// The head of every scenario file in `folder` and below; with tags, as of `scenarios_in`.
Result<std::vector<ListedScenario>> scenario_heads(const std::filesystem::path& folder,
                                                   std::span<const std::string> tags);

/// Every scenario file in `folder` and below, read with `overrides` on top. With tags, only
/// scenarios that have any of them, and files whose tags cannot be read. Errors:
/// two files of one name, a tag that no scenario has.
Result<std::vector<ScenarioFile>> scenarios_in(const std::filesystem::path& folder,
                                               std::span<const std::string> tags,
                                               std::span<const std::string> overrides = {});

/// `find_scenario`, whose error names `--tags` where `name` is a tag.
Result<std::filesystem::path> named_scenario(const std::string& name,
                                             const std::filesystem::path& folder);

/// The scenarios of these files or names, then all others in `folder` that have any of the tags;
/// without either every scenario there. Each comes once. Errors as of `scenarios_in` and
/// `find_scenario`, and a folder without any scenario.
Result<std::vector<ScenarioFile>> select_scenarios(std::span<const std::string> names,
                                                   std::span<const std::string> tags,
                                                   const std::filesystem::path& folder,
                                                   std::span<const std::string> overrides = {});

/// A line per scenario.
std::vector<CatalogueEntry> scenario_catalogue(std::span<const ListedScenario> files);

/// The families of those scenarios, by name.
std::vector<Family> families_of(std::span<const ListedScenario> files);

/// Every robot, with its mass and legs.
std::vector<CatalogueEntry> robot_catalogue();

/// Every LiDAR model, with what it fires.
std::vector<CatalogueEntry> lidar_catalogue();

/// Every registered estimator.
std::vector<CatalogueEntry> estimator_catalogue();

/// Where the shipped scenarios are: ./scenarios, else the first `scenarios` or
/// `share/aims/scenarios` found going up from the folder of `executable`.
std::filesystem::path default_scenario_folder(const std::filesystem::path& executable);

}  // namespace aims
