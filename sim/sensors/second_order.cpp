// SPDX-License-Identifier: BSD-3-Clause
#include "sim/sensors/second_order.hpp"

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

}  // namespace aims
