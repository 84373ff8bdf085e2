// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/legs/contact_detector.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>

namespace aims {
namespace {

constexpr std::size_t kMinLoads = 100;
constexpr double kMinFraction = 0.05;    ///< of the loads in each class [-]
constexpr double kMinSeparation = 3.7;   ///< distance of the means over the spread within [-]
constexpr double kMinRatio = 1.5;        ///< of 1 + mean load of the upper class over the lower [-]
constexpr double kHalfHysteresis = 0.1;  ///< of the distance of the means [-]
constexpr std::array<const char*, kLegCount> kFeet = {"FL", "FR", "RL", "RR"};

struct Moments {
  double mean = 0.0;
  double variance = 0.0;
};

Moments moments_of(std::span<const double> values) {
  Moments result;
  for (const double value : values) result.mean += value;
  result.mean /= static_cast<double>(values.size());
  for (const double value : values) result.variance += std::pow(value - result.mean, 2);
  result.variance /= static_cast<double>(values.size());
  return result;
}

/// The number of sorted values in the lower of two classes whose variance between is greatest.
std::size_t best_split(std::span<const double> sorted) {
  double total = 0.0;
  for (const double value : sorted) total += value;
  double best = -1.0, below = 0.0;
  std::size_t split = 0;
  for (std::size_t i = 1; i < sorted.size(); ++i) {
    below += sorted[i - 1];
    if (sorted[i] == sorted[i - 1]) continue;
    const auto lower = static_cast<double>(i);
    const auto upper = static_cast<double>(sorted.size() - i);
    const double between = lower * upper * std::pow((total - below) / upper - below / lower, 2);
    if (between > best) {
      best = between;
      split = i;
    }
  }
  return split;
}

Result<ContactThreshold> learn_threshold(std::vector<double> logarithms) {
  std::ranges::sort(logarithms);
  const std::size_t split = best_split(logarithms);
  const double fraction = static_cast<double>(split) / static_cast<double>(logarithms.size());
  if (split == 0) return failure("all loads are equal");
  const std::span<const double> all = logarithms;
  const Moments low = moments_of(all.first(split));
  const Moments high = moments_of(all.subspan(split));
  const double distance = high.mean - low.mean;
  const double spread = std::sqrt(0.5 * (low.variance + high.variance));
  if (fraction < kMinFraction || fraction > 1.0 - kMinFraction ||
      distance < kMinSeparation * spread) {
    return failure(
        fmt::format("loads near {:.0f} ({:.0f} %) and {:.0f} are not two classes "
                    "(separation {:.1f}, expected {})",
                    std::expm1(low.mean), 100.0 * fraction, std::expm1(high.mean),
                    distance / spread, kMinSeparation));
  }
  if (distance < std::log(kMinRatio)) {
    return failure(fmt::format(
        "loads near {:.0f} and {:.0f} are those of a standing foot: a lifted one has less "
        "than 1/{} of the load",
        std::expm1(low.mean), std::expm1(high.mean), kMinRatio));
  }
  const double middle = 0.5 * (low.mean + high.mean);
  return ContactThreshold{std::expm1(middle + kHalfHysteresis * distance),
                          std::expm1(middle - kHalfHysteresis * distance)};
}

}  // namespace

std::array<bool, kLegCount> ContactDetector::detect(const FootLoads& loads) {
  for (std::size_t leg = 0; leg < loads.size(); ++leg) {
    const ContactThreshold& threshold = thresholds_[leg];
    const double load = threshold.sign == 0 ? std::abs(loads[leg]) : threshold.sign * loads[leg];
    contact_[leg] = load >= (contact_[leg] ? threshold.end : threshold.begin);
  }
  return contact_;
}

bool ContactDetector::contradicts_sign(const FootLoads& loads) const {
  for (std::size_t leg = 0; leg < loads.size(); ++leg) {
    const ContactThreshold& threshold = thresholds_[leg];
    if (threshold.sign != 0 && -threshold.sign * loads[leg] >= threshold.begin) return true;
  }
  return false;
}

Result<ContactThreshold> learn_contact_threshold(const std::vector<FootLoads>& loads,
                                                 std::size_t leg) {
  std::vector<double> logarithms;
  for (const FootLoads& each : loads) {
    if (std::isfinite(each[leg])) logarithms.push_back(std::log1p(std::abs(each[leg])));
  }
  if (logarithms.size() < kMinLoads) {
    return failure(fmt::format("{}: expected at least {} loads, found {}", kFeet[leg], kMinLoads,
                               logarithms.size()));
  }
  const auto learned = learn_threshold(std::move(logarithms));
  if (!learned) return failure(fmt::format("{}: {}", kFeet[leg], learned.error().message));
  return learned;
}

Result<std::array<ContactThreshold, kLegCount>> learn_contact_thresholds(
    const std::vector<FootLoads>& loads) {
  std::array<ContactThreshold, kLegCount> thresholds;
  for (std::size_t leg = 0; leg < thresholds.size(); ++leg) {
    const auto learned = learn_contact_threshold(loads, leg);
    if (!learned) return tl::unexpected(learned.error());
    thresholds[leg] = *learned;
  }
  return thresholds;
}

}  // namespace aims
