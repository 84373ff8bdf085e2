// SPDX-License-Identifier: BSD-3-Clause
#include "harness/catalogue.hpp"

#include "estimator/registry.hpp"
#include "harness/scenario.hpp"

namespace aims {

namespace fs = std::filesystem;

std::vector<CatalogueEntry> scenario_catalogue(const fs::path& folder) {
  std::vector<CatalogueEntry> entries;
  for (const fs::path& file : scenario_files(folder)) {
    const auto scenario = load_scenario(file, {});
    if (scenario) {
      entries.push_back({file.stem().string(), scenario->description, scenario->tags});
    } else {
      entries.push_back({file.stem().string(), "does not load: " + scenario.error().message, {}});
    }
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
