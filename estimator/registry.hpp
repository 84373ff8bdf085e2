// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.hpp"
#include "estimator/interface/estimator_config.hpp"

namespace aims {

/// An estimator that can be created by name.
struct EstimatorEntry {
  std::string_view name;
  std::string_view description;  ///< one line
  /// Name of the entry that it is with other settings, e.g. as published; empty: a system of its
  /// own.
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

/// One configuration per registered estimator, by its name, and of those in Python that were added;
/// copies are deep.
class EstimatorConfigs {
 public:
  /// The defaults of every estimator.
  EstimatorConfigs();
  EstimatorConfigs(const EstimatorConfigs& other);
  EstimatorConfigs(EstimatorConfigs&&) noexcept = default;
  EstimatorConfigs& operator=(const EstimatorConfigs& other);
  EstimatorConfigs& operator=(EstimatorConfigs&&) noexcept = default;
  ~EstimatorConfigs() = default;

  /// Adds the class of a name like "python:module.Class" unless it is there. Error when it cannot
  /// be imported (estimator/python/python_estimator.hpp); nothing for other names.
  Result<void> add_python(std::string_view name);

  /// The configuration of the estimator `name`, or nullptr.
  EstimatorConfig* find(std::string_view name);
  const EstimatorConfig* find(std::string_view name) const;

 private:
  friend void describe(Fields& fields, EstimatorConfigs& configs);

  std::map<std::string, std::unique_ptr<EstimatorConfig>, std::less<>> configs_;
};

/// Each configuration under its name, in the order of the registry.
void describe(Fields& fields, EstimatorConfigs& configs);

/// Creates the estimator `name` with its default configuration. Error for an unknown name.
Result<std::unique_ptr<Estimator>> make_estimator(std::string_view name, const SensorRig& rig);

}  // namespace aims
