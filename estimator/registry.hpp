// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <span>
#include <string_view>

#include "core/error.hpp"
#include "estimator/aims/config.hpp"
#include "estimator/estimator.hpp"

namespace aims {

/// An estimator that can be created by name.
struct EstimatorEntry {
  std::string_view name;
  std::string_view description;  ///< one line
  bool needs_legs = true;        ///< leg odometry is a required input
};

/// All estimators, in the order of presentation.
std::span<const EstimatorEntry> estimator_registry();

/// Whether the estimator `name` requires leg odometry; an unknown name requires none.
bool needs_legs(std::string_view name);

/// Creates the estimator `name`. Error for an unknown name, with a near match and the list.
Result<std::unique_ptr<Estimator>> make_estimator(std::string_view name,
                                                  const EstimatorConfig& config,
                                                  const SensorRig& rig);

}  // namespace aims
