// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <span>
#include <string>

#include "core/measurements.hpp"

namespace aims {

/// What the signs of the loads of a foot tell of its sensor.
enum class LoadSign {
  kPositive,  ///< as it should be: hardly any is negative
  kNegative,  ///< between zero and negative: the sign is reversed, the magnitude is right
  kUnclear,   ///< negative, and no zero of a lifted foot: an offset, with or without that sign
};

/// The loads of a foot: the twentieth from either end, and what they tell.
struct LoadRange {
  double low = 0.0, high = 0.0;
  LoadSign sign = LoadSign::kPositive;
};

/// Of loads that push a foot up in one direction, which torques do not. Loads of at most
/// `negligible` are nothing.
std::array<LoadRange, kLegCount> load_ranges(std::span<const FootLoads> loads, double negligible);

/// "FL (-80 to -2), RR (-75 to 0)" of the feet with that sign; empty without.
std::string feet_text(const std::array<LoadRange, kLegCount>& ranges, LoadSign sign);

}  // namespace aims
