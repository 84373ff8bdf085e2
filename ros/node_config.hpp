// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "core/config.hpp"
#include "core/error.hpp"
#include "estimator/estimator_config.hpp"
#include "recordings/recording_config.hpp"
#include "ros/node_options.hpp"

namespace aims {

/// The groups of `aims estimate` that apply to a live estimate. The same file serves both, if it
/// has no other groups.
struct NodeConfig {
  RecordingConfig recording;
  EstimatorConfigs estimators;
  std::string estimator = "aims";  ///< spec of who estimates; from the options
};

void describe(Fields& fields, NodeConfig& config);

/// Reads the options' file and applies their settings on top. Error for an unknown estimator too.
Result<NodeConfig> load_node_config(const NodeOptions& options);

}  // namespace aims
