// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/estimator_config.hpp"

#include "estimator/python/python_estimator.hpp"
#include "estimator/registry.hpp"

namespace aims {

EstimatorConfigs::EstimatorConfigs() {
  for (const EstimatorEntry& entry : estimator_registry()) {
    configs_.emplace(entry.name, entry.config());
  }
}

EstimatorConfigs::EstimatorConfigs(const EstimatorConfigs& other) {
  for (const auto& [name, config] : other.configs_) configs_.emplace(name, config->clone());
}

EstimatorConfigs& EstimatorConfigs::operator=(const EstimatorConfigs& other) {
  if (this != &other) *this = EstimatorConfigs(other);
  return *this;
}

Result<void> EstimatorConfigs::add_python(std::string_view name) {
  if (!is_python_name(name) || configs_.contains(name)) return {};
  auto config = PythonConfig::load(name);
  if (!config) return tl::unexpected(config.error());
  configs_.emplace(name, std::make_unique<PythonConfig>(std::move(*config)));
  return {};
}

EstimatorConfig* EstimatorConfigs::find(std::string_view name) {
  const auto found = configs_.find(name);
  return found == configs_.end() ? nullptr : found->second.get();
}

const EstimatorConfig* EstimatorConfigs::find(std::string_view name) const {
  const auto found = configs_.find(name);
  return found == configs_.end() ? nullptr : found->second.get();
}

void describe(Fields& fields, EstimatorConfigs& configs) {
  for (const EstimatorEntry& entry : estimator_registry()) {
    fields.group_of(entry.name, fields_of(*configs.find(entry.name)));
  }
}

}  // namespace aims
