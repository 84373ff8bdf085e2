// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace aims {

/// One line of a listing.
struct CatalogueEntry {
  std::string name;
  std::string description;  ///< for a scenario that does not load: why
  std::vector<std::string> tags;
};

/// Every scenario of `folder`.
std::vector<CatalogueEntry> scenario_catalogue(const std::filesystem::path& folder);

/// Every registered estimator.
std::vector<CatalogueEntry> estimator_catalogue();

/// Where the shipped scenarios are: ./scenarios, else the first `scenarios` or
/// `share/aims/scenarios` found going up from the folder of `executable`.
std::filesystem::path default_scenario_folder(const std::filesystem::path& executable);

}  // namespace aims
