// SPDX-License-Identifier: BSD-3-Clause
#include "bench/run/catalogue.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "bench/run/lidar_sheet.hpp"
#include "bench/run/robot_sheet.hpp"
#include "estimator/registry.hpp"

namespace aims {

namespace fs = std::filesystem;

namespace {

bool has_any(const Scenario& scenario, std::span<const std::string> tags) {
  return std::any_of(tags.begin(), tags.end(), [&](const std::string& tag) {
    return std::find(scenario.tags.begin(), scenario.tags.end(), tag) != scenario.tags.end();
  });
}

/// Error for the first tag that no scenario has, with those that there are.
Result<void> check_tags(std::span<const ScenarioFile> files, std::span<const std::string> tags) {
  std::set<std::string> known;
  for (const ScenarioFile& each : files) {
    if (each.scenario) known.insert(each.scenario->tags.begin(), each.scenario->tags.end());
  }
  for (const std::string& tag : tags) {
    if (!known.contains(tag)) {
      return failure(fmt::format("--tags: no scenario has the tag '{}'; there are {}", tag,
                                 fmt::join(known, ", ")));
    }
  }
  return {};
}

}  // namespace

Result<std::vector<ScenarioFile>> scenarios_in(const fs::path& folder,
                                               std::span<const std::string> tags,
                                               std::span<const std::string> overrides) {
  const auto paths = scenario_files(folder);
  if (!paths) return tl::unexpected(paths.error());
  std::vector<ScenarioFile> files;
  for (const fs::path& path : *paths)
    files.push_back({path, load_scenario(path, overrides, folder)});
  if (tags.empty()) return files;
  if (auto known = check_tags(files, tags); !known) return tl::unexpected(known.error());
  std::erase_if(files, [&](const ScenarioFile& each) {
    return each.scenario && !has_any(*each.scenario, tags);
  });
  return files;
}

Result<std::vector<ScenarioFile>> select_scenarios(std::span<const std::string> names,
                                                   std::span<const std::string> tags,
                                                   const fs::path& folder,
                                                   std::span<const std::string> overrides) {
  std::vector<ScenarioFile> selected;
  const auto add = [&selected](ScenarioFile file) {
    const bool known = std::any_of(selected.begin(), selected.end(), [&](const auto& each) {
      return fs::weakly_canonical(each.file) == fs::weakly_canonical(file.file);
    });
    if (!known) selected.push_back(std::move(file));
  };
  for (const std::string& name : names) {
    const auto file = find_scenario(name, folder);
    if (!file) return tl::unexpected(file.error());
    add({*file, load_scenario(*file, overrides, folder)});
  }
  if (!names.empty() && tags.empty()) return selected;
  auto files = scenarios_in(folder, tags, overrides);
  if (!files) return files;
  for (ScenarioFile& each : *files) add(std::move(each));
  if (!selected.empty()) return selected;
  return failure(fmt::format("{}: holds no scenario", folder.string()));
}

std::vector<CatalogueEntry> scenario_catalogue(std::span<const ScenarioFile> files) {
  std::vector<CatalogueEntry> entries;
  for (const auto& [file, scenario] : files) {
    if (scenario) {
      entries.push_back({file.stem().string(), scenario->description, scenario->tags});
    } else {
      entries.push_back({file.stem().string(), "does not load: " + scenario.error().message, {}});
    }
  }
  return entries;
}

std::vector<Family> families_of(std::span<const ScenarioFile> files) {
  std::map<std::string, std::vector<const Scenario*>> members;
  for (const ScenarioFile& each : files) {
    if (each.scenario && !each.scenario->family.empty()) {
      members[each.scenario->family].push_back(&*each.scenario);
    }
  }
  std::vector<Family> families;
  for (auto& [name, scenarios] : members) {
    std::stable_sort(scenarios.begin(), scenarios.end(),
                     [](const Scenario* a, const Scenario* b) { return a->level < b->level; });
    Family family{name, scenarios.front()->level_unit, {}};
    for (const Scenario* scenario : scenarios) family.cases.push_back(scenario->name);
    families.push_back(std::move(family));
  }
  return families;
}

std::vector<CatalogueEntry> robot_catalogue() {
  std::vector<CatalogueEntry> entries;
  for (const RobotModel& model : robot_models()) {
    SimulationConfig config;
    const auto sheet = apply_robot_model(model.name, SensorLevel::kIdeal, config);
    entries.push_back({std::string(model.name),
                       sheet ? robot_summary(*sheet, config) : sheet.error().message,
                       {}});
  }
  return entries;
}

std::vector<CatalogueEntry> lidar_catalogue() {
  std::vector<CatalogueEntry> entries;
  for (const LidarModel& model : lidar_models()) {
    LidarConfig config;
    const auto sheet = apply_lidar_model(model.name, SensorLevel::kIdeal, config);
    entries.push_back({std::string(model.name),
                       sheet ? lidar_summary(*sheet, config) : sheet.error().message,
                       {}});
  }
  return entries;
}

std::vector<CatalogueEntry> estimator_catalogue() {
  std::vector<CatalogueEntry> entries;
  for (const EstimatorEntry& entry : estimator_registry()) {
    entries.push_back({std::string(entry.name), std::string(entry.description), {}});
  }
  return entries;
}

fs::path default_scenario_folder(const fs::path& executable) {
  if (fs::is_directory("scenarios")) return "scenarios";
  for (fs::path folder = executable.parent_path(); folder.has_relative_path();
       folder = folder.parent_path()) {
    for (const char* candidate : {"share/aims/scenarios", "scenarios"}) {
      if (fs::is_directory(folder / candidate)) return folder / candidate;
    }
  }
  return "scenarios";
}

}  // namespace aims
