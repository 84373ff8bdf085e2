// SPDX-License-Identifier: BSD-3-Clause
#include "sim/sensors/low_pass.hpp"

#include <cmath>
#include <numbers>

namespace aims {

LowPass::LowPass(double bandwidth, int order, double step) {
  if (bandwidth <= 0.0) return;
  if (order == 2) second_.emplace(bandwidth, std::numbers::sqrt2 / 2.0, step);
  if (order == 1) kept_ = std::exp(-2.0 * std::numbers::pi * bandwidth * step);
}

Eigen::Vector3d LowPass::filter(const Eigen::Vector3d& input) {
  if (!output_) {
    if (second_) second_->settle(input);
    output_ = input;
    return input;
  }
  if (second_) {
    second_->step(input);
    output_ = second_->position();
  } else {
    *output_ = input + kept_ * (*output_ - input);
  }
  return *output_;
}

double noise_bandwidth(double bandwidth, int order) {
  // Integral of the squared gain: pi/2 for the first order, pi / (2 sqrt(2)) for Butterworth's
  // second.
  const double ratio = 0.5 * std::numbers::pi;
  return bandwidth * (order == 2 ? ratio / std::numbers::sqrt2 : ratio);
}

}  // namespace aims
