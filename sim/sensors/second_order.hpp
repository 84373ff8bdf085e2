// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

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

}  // namespace aims
