// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/config.hpp"
#include "core/error.hpp"
#include "estimator/registry.hpp"

namespace aims {

/// Specification of an estimator: its name, its label in the results, and settings that override
/// its configuration. Written `NAME`, `LABEL=NAME` or `LABEL=NAME+key=value+key=value`, keys
/// relative to `estimators.NAME.`; e.g. `no_ground=aims_d+ground_constraint.enabled=false`. A name
/// `python:module.Class` is a class in Python, whose settings are keywords of its constructor.
struct EstimatorSpec {
  std::string label;  ///< of results and files: letters, digits, - and _
  std::string name;   ///< in the registry, or python:module.Class
  std::vector<std::pair<std::string, std::string>> settings;  ///< key and value, in order
};

/// Parses `text`. Without a label, one is made of name and settings. Error for an unknown estimator
/// or key (both with a near match), a value that is not allowed, a label with other characters, or
/// a label that is the name of another estimator. Settings of a class in Python are not checked
/// here.
Result<EstimatorSpec> parse_estimator_spec(std::string_view text);

/// The text that `parse_estimator_spec` reads.
std::string text_of(const EstimatorSpec& spec);

/// The same without the label, `NAME+key=value`: identifies the run.
std::string unlabelled_text(const EstimatorSpec& spec);

/// The configuration of the spec's estimator in `base` with the settings of the spec on top. Error
/// for an unknown key or value, and for a setting without effect.
Result<std::unique_ptr<EstimatorConfig>> config_with(const EstimatorSpec& spec,
                                                     const EstimatorConfigs& base);

/// What the spec's estimator requires; nothing for a spec that cannot be read.
Requirements requirements_of(std::string_view spec, const EstimatorConfigs& base);

/// Adds the classes in Python that `run` names to `configs`, so that each is imported once. Error
/// when one cannot be imported.
Result<void> add_python_estimators(std::span<const std::string> run, EstimatorConfigs& configs);

/// Adds the group `estimators` to `fields`: each estimator by its name, and by its label each class
/// in Python of `run` that was added to `configs`. A setting is idle where it has no effect in any
/// spec of `run`, and those of a class with several labels are.
void describe_estimators(Fields& fields, const std::vector<std::string>& run,
                         EstimatorConfigs& configs);

/// Error for a key that was set without effect, and for such a setting in a spec of `run`. With
/// `run_chosen`, by the command line, files may hold settings of estimators that do not run.
Result<void> check_effects(const Fields& fields, std::vector<AssignedKey> assigned, bool run_chosen,
                           std::span<const std::string> run, const EstimatorConfigs& configs);

/// The label of a spec, well-formed or not.
std::string label_of(std::string_view spec);

/// The labels of several specs, in order.
std::vector<std::string> labels_of(std::span<const std::string> specs);

/// Error for a malformed spec and for a repeated label.
Result<void> check_estimator_specs(std::span<const std::string> specs);

/// The setting "run=[...]" for a scenario or an estimate.
std::string run_setting(std::span<const std::string> specs);

/// Whether `setting` ("key=value") is such a one.
bool is_run_setting(std::string_view setting);

/// Stands for every system (`system_names`) on a command line.
inline constexpr std::string_view kAllEstimators = "all";

/// Specs of a command line split at commas, with the commas inside brackets restored:
/// {"aims_d+x=[1", "2]"} is one spec; "all" is every system.
std::vector<std::string> joined_specs(std::span<const std::string> pieces);

}  // namespace aims
