// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <string_view>

#include "estimator/aims/config.hpp"

namespace aims {

/// A named configuration of the filter.
struct EskfPreset {
  std::string_view name;
  std::string_view description;  ///< one line
  EskfConfig (*config)();
};

/// All presets, in the order of presentation.
std::span<const EskfPreset> eskf_presets();

/// The configuration of the preset `name`, which must be one of them.
EskfConfig eskf_preset(std::string_view name);

}  // namespace aims
