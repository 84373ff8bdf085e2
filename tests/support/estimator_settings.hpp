// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>

#include "core/config.hpp"
#include "estimator/registry.hpp"

namespace aims::test {

/// The text of a setting, e.g. "aims.degeneracy.eta"; "no such key" without it.
inline std::string setting(EstimatorConfigs configs, std::string_view key) {
  const Fields fields = fields_of(configs);
  const Parameter* parameter = fields.find(key);
  return parameter == nullptr ? "no such key" : parameter->text();
}

/// The number of a setting.
inline double number(const EstimatorConfigs& configs, std::string_view key) {
  return std::stod(setting(configs, key));
}

/// `configs` with a setting on top; unchanged when there is no such key or value.
inline EstimatorConfigs with(EstimatorConfigs configs, std::string_view key,
                             std::string_view value) {
  (void)assign(fields_of(configs), key, value);
  return configs;
}

}  // namespace aims::test
