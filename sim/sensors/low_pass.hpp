// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <optional>

namespace aims {

/// x'' + 2 zeta w x' + w^2 x = w^2 u on three axes at once, integrated exactly for an input that is
/// constant over each step: stable at every step. A static input passes with gain one.
class SecondOrderSystem {
 public:
  /// `frequency` [Hz], positive; damping ratio zeta in (0, 1); step [s].
  SecondOrderSystem(double frequency, double damping, double step);

  /// At rest under that input.
  void settle(const Eigen::Vector3d& input);
  void step(const Eigen::Vector3d& input);

  const Eigen::Vector3d& position() const { return position_; }  ///< low-pass of the input
  /// 2 zeta / w x': band-pass of the input, gain one at the frequency.
  Eigen::Vector3d band() const { return band_gain_ * velocity_; }

 private:
  double band_gain_;                                          ///< [s]
  Eigen::Matrix2d transition_ = Eigen::Matrix2d::Identity();  ///< of (x - u, x') over a step
  Eigen::Vector3d position_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d velocity_ = Eigen::Vector3d::Zero();  ///< [1/s]
};

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
