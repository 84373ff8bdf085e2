// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/baselines/lego_loam/azimuth_times.hpp"

#include <numbers>

namespace aims::lego_loam {
namespace {

constexpr double kPi = std::numbers::pi;

}  // namespace

AzimuthTimes::AzimuthTimes(double first_azimuth, double last_azimuth)
    : start_(-first_azimuth), end_(-last_azimuth + 2.0 * kPi) {
  if (end_ - start_ > 3.0 * kPi) end_ -= 2.0 * kPi;
  if (end_ - start_ < kPi) end_ += 2.0 * kPi;
}

double AzimuthTimes::next(double azimuth) {
  double orientation = -azimuth;
  if (half_passed_) {
    orientation += 2.0 * kPi;
    if (orientation < end_ - 1.5 * kPi) {
      orientation += 2.0 * kPi;
    } else if (orientation > end_ + 0.5 * kPi) {
      orientation -= 2.0 * kPi;
    }
  } else {
    if (orientation < start_ - 0.5 * kPi) {
      orientation += 2.0 * kPi;
    } else if (orientation > start_ + 1.5 * kPi) {
      orientation -= 2.0 * kPi;
    }
    half_passed_ = orientation - start_ > kPi;
  }
  return (orientation - start_) / (end_ - start_);
}

}  // namespace aims::lego_loam
