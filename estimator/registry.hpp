// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.hpp"
#include "estimator/estimator_config.hpp"

namespace aims {

/// An estimator that can be created by name.
struct EstimatorEntry {
  std::string_view name;
  std::string_view description;  ///< one line
  /// Name of the entry that it is with other settings, e.g. as published; empty: a system of its own.
  std::string_view preset_of;
  /// Its default configuration, which states its requirements and creates it.
  std::function<std::unique_ptr<EstimatorConfig>()> config;
};

/// All estimators, in the order of presentation.
std::span<const EstimatorEntry> estimator_registry();

/// Their names.
std::vector<std::string> estimator_names();

/// Names of those that are a system of their own.
std::vector<std::string> system_names();

/// Error for a name that is not registered, with a near match and the list.
Result<void> check_estimator_name(std::string_view name);

/// Creates the estimator `name` with its default configuration. Error for an unknown name.
Result<std::unique_ptr<Estimator>> make_estimator(std::string_view name, const SensorRig& rig);

}  // namespace aims
