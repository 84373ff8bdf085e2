// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <optional>

#include "sim/sensors/second_order.hpp"

namespace aims {

/// Low-pass of an inertial chip before it samples: of first order, or a Butterworth filter of
/// second order. Exact for an input that is constant over each step.
class LowPass {
 public:
  /// `bandwidth`: where the gain is 1/sqrt(2) [Hz], 0 for no filter; `order` 1 or 2; step [s].
  LowPass(double bandwidth, int order, double step);

  /// Returns the output after one more step; the first input counts as constant before.
  Eigen::Vector3d filter(const Eigen::Vector3d& input);

 private:
  double kept_ = 0.0;  ///< of the first order's difference after a step
  std::optional<SecondOrderSystem> second_;
  std::optional<Eigen::Vector3d> output_;
};

/// Bandwidth [Hz] of white noise that has the power of noise behind that filter.
double noise_bandwidth(double bandwidth, int order);

}  // namespace aims
