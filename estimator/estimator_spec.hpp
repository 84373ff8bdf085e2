// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/error.hpp"
#include "estimator/aims/config.hpp"

namespace aims {

/// Specification of an estimator: its name, its label in the results, and settings that override
/// the common configuration. Written `NAME`, `LABEL=NAME` or `LABEL=NAME+key=value+key=value`, keys
/// relative to `estimator.`; e.g. `no_ground=aims_d+directional.ground_constraint.enabled=false`.
struct EstimatorSpec {
  std::string label;  ///< of results and files: letters, digits, - and _
  std::string name;   ///< in the registry
  std::vector<std::pair<std::string, std::string>> settings;  ///< key and value, in order
};

/// Parses `text`. Without a label, one is made of name and settings. Error for an unknown estimator
/// or key (both with a near match), a value that is not allowed, a label with other characters, or
/// a label that is the name of another estimator.
Result<EstimatorSpec> parse_estimator_spec(std::string_view text);

/// The text that `parse_estimator_spec` reads.
std::string text_of(const EstimatorSpec& spec);

/// The same without the label, `NAME+key=value`: identifies the run.
std::string unlabelled_text(const EstimatorSpec& spec);

/// `base` with the settings of the spec on top. Error for an unknown key or value.
Result<EstimatorConfig> config_with(const EstimatorSpec& spec, const EstimatorConfig& base);

/// The label of a spec, well-formed or not.
std::string label_of(std::string_view spec);

/// The labels of several specs, in order.
std::vector<std::string> labels_of(std::span<const std::string> specs);

/// Error for a malformed spec and for a repeated label.
Result<void> check_estimator_specs(std::span<const std::string> specs);

/// The setting "estimators=[...]" for a scenario or an estimate.
std::string estimators_setting(std::span<const std::string> specs);

/// Specs of a command line split at commas, with the commas inside brackets restored:
/// {"aims_d+x=[1", "2]"} is one spec.
std::vector<std::string> joined_specs(std::span<const std::string> pieces);

}  // namespace aims
