// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/legs/joint_rates.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "core/median.hpp"

namespace aims {
namespace {

/// So long angles change by more than noise, and drivers that send some twice send a new one.
constexpr Duration kWindow = kSecond / 20;
constexpr Duration kMaxStep = kSecond / 10;
constexpr double kMoves = 0.02;  ///< [rad]
constexpr std::size_t kFewest = 200, kMost = 20'000;
/// Of ratios near the median. A touchdown turns joints otherwise than the rates before and after.
constexpr double kNear = 0.4, kMostly = 0.6;
/// Filters of drivers and late rates lower the ratio.
constexpr double kLeastScale = 0.5, kMostScale = 2.0;
constexpr double kLeastDegrees = 40.0, kMostDegrees = 80.0;  ///< of deg/s: 57

bool is_degrees(double scale) { return scale > kLeastDegrees && scale < kMostDegrees; }

std::string cause_of(double scale) {
  if (is_degrees(scale)) return "the rates are in deg/s beside angles in rad";
  if (is_degrees(1.0 / scale)) return "the angles are in degrees beside rates in rad/s";
  if (scale < 0.0) return "the rates have the opposite sign";
  return "the rates have another scale, as those of motors before their gears";
}

}  // namespace

void JointRateCheck::begin(const JointReading& reading) {
  first_ = reading;
  turned_.fill(0.0);
}

void JointRateCheck::close(const JointReading& reading) {
  for (std::size_t i = 0; i < turned_.size(); ++i) {
    const double moved = reading.position[i] - first_->position[i];
    if (std::abs(moved) < kMoves || ratios_.size() == kMost) continue;
    ratios_.push_back(turned_[i] / moved);
  }
  begin(reading);
}

void JointRateCheck::add(const JointReading& reading) {
  const auto is_number = [](double each) { return std::isfinite(each); };
  const bool usable = reading.velocity && !reading.differenced &&
                      std::ranges::all_of(*reading.velocity, is_number) &&
                      std::ranges::all_of(reading.position, is_number) &&
                      std::ranges::count(reading.unknown, true) == 0;
  if (!usable) return first_.reset();
  const Duration step = last_ && first_ ? reading.stamp - last_->stamp : 0;
  if (!first_ || step < 0 || step > kMaxStep) {
    begin(reading);
  } else {
    for (std::size_t i = 0; i < turned_.size(); ++i) {
      turned_[i] += 0.5 * ((*last_->velocity)[i] + (*reading.velocity)[i]) * to_seconds(step);
    }
    if (reading.stamp - first_->stamp >= kWindow) close(reading);
  }
  last_ = reading;
}

std::optional<ReadingWarning> JointRateCheck::warning() const {
  if (ratios_.size() < kFewest) return std::nullopt;
  const double scale = *upper_median(ratios_);
  const auto near = std::ranges::count_if(
      ratios_, [scale](double each) { return std::abs(each - scale) < kNear * std::abs(scale); });
  const bool agree = static_cast<double>(near) >= kMostly * static_cast<double>(ratios_.size());
  if (!agree || (scale > kLeastScale && scale < kMostScale)) return std::nullopt;
  return ReadingWarning{
      "rates of the joints contradict their angles",
      fmt::format("the rates of the joints are {:.3g} times what their angles change by in a "
                  "second: {}; correct the driver, or leave the rates out: then differences of "
                  "the angles serve",
                  scale, cause_of(scale)),
      WarnedSensor::kLegs, WarningKind::kJointRates};
}

}  // namespace aims
