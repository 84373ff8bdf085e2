// SPDX-License-Identifier: BSD-3-Clause
#include "sim/sensors/low_pass.hpp"

#include <cmath>
#include <numbers>

namespace aims {

SecondOrderSystem::SecondOrderSystem(double frequency, double damping, double step) {
  const double w = 2.0 * std::numbers::pi * frequency;
  const double decay = damping * w;
  const double damped = w * std::sqrt(1.0 - damping * damping);
  const double envelope = std::exp(-decay * step);
  const double c = envelope * std::cos(damped * step);
  const double s = envelope * std::sin(damped * step) / damped;
  band_gain_ = 2.0 * damping / w;
  transition_ << c + decay * s, s, -w * w * s, c - decay * s;
}

void SecondOrderSystem::settle(const Eigen::Vector3d& input) {
  position_ = input;
  velocity_.setZero();
}

void SecondOrderSystem::step(const Eigen::Vector3d& input) {
  const Eigen::Vector3d away = position_ - input;
  position_ = input + transition_(0, 0) * away + transition_(0, 1) * velocity_;
  velocity_ = transition_(1, 0) * away + transition_(1, 1) * velocity_;
}

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
