// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "core/files/yaml_config.hpp"
#include "estimator/registry.hpp"

namespace aims {

/// `run` as it is read.
struct RunChoice {
  std::vector<std::string> of_file;  ///< of the file alone
  std::vector<std::string> all;      ///< with the overrides on top
};

/// Reads `run`, `standard` where nothing has it, before all other keys, and adds its classes in
/// Python to `configs`, so that the keys of their settings are known. Error when a class that runs
/// cannot be imported; what is malformed is left to who reads all keys.
Result<RunChoice> choose_run(const std::filesystem::path& file,
                             std::span<const std::string> overrides, const YamlFiles& files,
                             const std::vector<std::string>& standard, EstimatorConfigs& configs);

}  // namespace aims
