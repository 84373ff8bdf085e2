// SPDX-License-Identifier: BSD-3-Clause
#include "bench/scenario/catalogue.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <utility>

#include "bench/scenario/model_sheets.hpp"
#include "estimator/registry.hpp"

namespace aims {

namespace fs = std::filesystem;

namespace {

bool has_any(const ScenarioHead& scenario, std::span<const std::string> tags) {
  return std::any_of(tags.begin(), tags.end(), [&](const std::string& tag) {
    return std::find(scenario.tags.begin(), scenario.tags.end(), tag) != scenario.tags.end();
  });
}

/// Error for the first tag that no scenario has, with those that there are.
Result<void> check_tags(std::span<const ListedScenario> files, std::span<const std::string> tags) {
  std::set<std::string> known;
  for (const ListedScenario& each : files) {
    if (each.head) known.insert(each.head->tags.begin(), each.head->tags.end());
  }
  for (const std::string& tag : tags) {
    if (!known.contains(tag)) {
      const std::string near = near_match(tag, {known.begin(), known.end()});
      return failure(
          near.empty()
              ? fmt::format("--tags: no scenario has the tag '{}'; there are {}", tag,
                            fmt::join(known, ", "))
              : fmt::format("--tags: no scenario has the tag '{}'; did you mean '{}'?", tag, near));
    }
  }
  return {};
}

}  // namespace

Result<std::vector<ListedScenario>> scenario_heads(const fs::path& folder,
                                                   std::span<const std::string> tags) {
  const auto paths = scenario_files(folder);
  if (!paths) return tl::unexpected(paths.error());
  std::vector<ListedScenario> files;
  for (const fs::path& path : *paths) files.push_back({path, load_scenario_head(path, folder)});
  if (tags.empty()) return files;
  if (auto known = check_tags(files, tags); !known) return tl::unexpected(known.error());
  std::erase_if(
      files, [&](const ListedScenario& each) { return each.head && !has_any(*each.head, tags); });
  return files;
}

Result<std::vector<ScenarioFile>> scenarios_in(const fs::path& folder,
                                               std::span<const std::string> tags,
                                               std::span<const std::string> overrides) {
  const auto heads = scenario_heads(folder, tags);
  if (!heads) return tl::unexpected(heads.error());
  std::vector<ScenarioFile> files;
  for (const ListedScenario& each : *heads) {
    files.push_back({each.file, load_scenario(each.file, overrides, folder)});
  }
  return files;
}

Result<fs::path> named_scenario(const std::string& name, const fs::path& folder) {
  auto file = find_scenario(name, folder);
  if (file) return file;
  const auto members = scenario_heads(folder, std::array{name});
  if (!members) return file;  // no tag either
  return failure(
      fmt::format("{}: no scenario, but the tag of {} scenarios in {}; those are "
                  "aims suite --tags {}",
                  name, members->size(), folder.string(), name));
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
    const auto file = named_scenario(name, folder);
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

std::vector<CatalogueEntry> scenario_catalogue(std::span<const ListedScenario> files) {
  std::vector<CatalogueEntry> entries;
  for (const auto& [file, head] : files) {
    if (head) {
      entries.push_back({file.stem().string(), head->description, head->tags});
    } else {
      entries.push_back({file.stem().string(), "does not load: " + head.error().message, {}});
    }
  }
  return entries;
}

std::vector<Family> families_of(std::span<const ListedScenario> files) {
  std::map<std::string, std::vector<const ScenarioHead*>> members;
  for (const ListedScenario& each : files) {
    if (each.head && !each.head->family.empty()) members[each.head->family].push_back(&*each.head);
  }
  std::vector<Family> families;
  for (auto& [name, scenarios] : members) {
    std::stable_sort(scenarios.begin(), scenarios.end(),
                     [](const auto* a, const auto* b) { return a->level < b->level; });
    Family family{name, scenarios.front()->level_unit, {}};
    for (const ScenarioHead* scenario : scenarios) family.cases.push_back(scenario->name);
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
