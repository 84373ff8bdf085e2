// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/legs/load_signs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/leg_kinematics.hpp"
#include "core/text.hpp"

namespace aims {
namespace {

// Of the largest load.
constexpr double kDrift = 0.1;    ///< of the other sign, by noise and drift of the sensor
constexpr double kLifted = 0.25;  ///< of a lifted foot whose sensor has the reversed sign

/// Some places in the loads of a foot, in order of size.
struct Places {
  double low, lower_part, upper_part, high;

  /// Loads of lifted feet lie together, those of standing ones apart.
  bool lifted_is_low() const { return high - upper_part > 3.0 * (lower_part - low); }
};

LoadSign sign_of(const Places& at, double negligible) {
  const double largest = std::max(std::abs(at.low), std::abs(at.high));
  if (largest <= negligible || at.low >= -kDrift * largest) return LoadSign::kPositive;
  const bool near_zero = at.high <= kDrift * largest && at.high >= -kLifted * largest;
  return near_zero && !at.lifted_is_low() ? LoadSign::kNegative : LoadSign::kUnclear;
}

LoadRange range_of(std::vector<double> loads, double negligible) {
  if (loads.empty()) return {};
  const auto at = [&loads](std::size_t index) {
    const auto place = loads.begin() + static_cast<std::ptrdiff_t>(index);
    std::ranges::nth_element(loads, place);
    return *place;
  };
  const std::size_t few = loads.size() / 20, part = loads.size() / 5, last = loads.size() - 1;
  const Places places = {at(few), at(part), at(last - part), at(last - few)};
  return {places.low, places.high, sign_of(places, negligible)};
}

}  // namespace

std::array<LoadRange, kLegCount> load_ranges(std::span<const FootLoads> loads, double negligible) {
  std::array<LoadRange, kLegCount> ranges;
  for (std::size_t leg = 0; leg < ranges.size(); ++leg) {
    std::vector<double> of_leg;
    for (const FootLoads& each : loads) {
      if (std::isfinite(each[leg])) of_leg.push_back(each[leg]);
    }
    ranges[leg] = range_of(std::move(of_leg), negligible);
  }
  return ranges;
}

std::string feet_text(const std::array<LoadRange, kLegCount>& ranges, LoadSign sign) {
  std::string text;
  for (std::size_t leg = 0; leg < ranges.size(); ++leg) {
    if (ranges[leg].sign != sign) continue;
    text += fmt::format("{}{} ({} to {})", text.empty() ? "" : ", ", kLegNames[leg],
                        decimal_text(ranges[leg].low, 0), decimal_text(ranges[leg].high, 0));
  }
  return text;
}

}  // namespace aims
