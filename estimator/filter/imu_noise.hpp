// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>

#include "core/measurements.hpp"

namespace aims {

/// White-noise densities of an inertial signal, the same along each axis.
struct ImuNoiseDensity {
  double gyro = 0.0;           ///< [rad/s/sqrt(Hz)]
  double accelerometer = 0.0;  ///< [m/s^2/sqrt(Hz)]
};

/// Variances of the samples of a signal, mean over the axes.
struct SignalVariance {
  double total = 0.0;  ///< about the running mean
  double white = 0.0;  ///< of the part that does not follow from the neighbours
};

/// Running variances of a signal of three axes, over about half a second; they rise within a few
/// samples, since the first steps come at once.
///
/// The second difference d_k = x_k - 2 x_(k-1) + x_(k-2) passes the upper half of the band: white
/// noise of variance s^2 gives E d^2 = 6 s^2, a motion of frequency f the fraction
/// (16/6) sin^4(pi f T) of its power, below 1 % for the stride of a quadruped at 50 Hz.
class SignalStatistics {
 public:
  /// Adds the sample `x`; `follows`: one sampling period after the last.
  void add(const Eigen::Vector3d& x, bool follows, double gain);

  const SignalVariance& variance() const { return variance_; }

 private:
  std::array<Eigen::Vector3d, 2> last_;  ///< newest first
  int count_ = 0;                        ///< samples in a row, at most 2
  bool started_ = false;
  Eigen::Vector3d mean_ = Eigen::Vector3d::Zero();
  double slow_white_ = 0.0;  ///< over half a second
  double fast_white_ = 0.0;  ///< over a few samples
  SignalVariance variance_;
};

/// Share of the white part of a signal that is noise, learned from corrections of its integral.
class NoiseShare {
 public:
  /// Adds a mean square correction, `expected` if all of the white part were noise.
  void add(double correction, double expected);

  double value() const;

 private:
  double corrections_ = 0.0;
  double expected_ = 0.0;
};

/// Deviations of the white part of one sample, per axis.
struct WhiteDeviation {
  double rate = 0.0;   ///< [rad/s]
  double force = 0.0;  ///< [m/s^2]
};

/// Noise of the integrated IMU, estimated from the IMU itself and from how well it predicts scans.
///
/// Vibration above half the sampling rate aliases into the samples and does not average out in
/// their sum: a sample's white part of deviation s adds a random walk of density s sqrt(T). What
/// share of that part is noise, and not motion that the samples follow (a filtered IMU), shows in
/// the corrections y of rotation and velocity: in the steady state all updates since the last scan
/// take what was added, E[y y^T] + sum (P- - P+) = Q, y by the scan and the sum over the updates by
/// legs (Myers and Tapley 1976).
class ImuNoise {
 public:
  explicit ImuNoise(double rate_hz);

  /// Adds the next sample in order of stamp.
  void add(const ImuSample& sample);

  /// Adds a scan's mean square correction per axis, of rotation [rad^2] and velocity [m^2/s^2], and
  /// what legs took since the last scan, `duration` [s] before, to the learned shares of noise.
  void add_correction(double rotation, double velocity, double duration);

  /// Of the sum of the samples.
  ImuNoiseDensity density() const;

  /// While samples are missing: the motion itself is unknown.
  ImuNoiseDensity bridge_density() const;

  /// Of one sample.
  WhiteDeviation white() const;

 private:
  double period_;  ///< [s]
  Time last_ = 0;
  bool started_ = false;
  SignalStatistics rate_;
  SignalStatistics force_;
  NoiseShare rate_share_;
  NoiseShare force_share_;
};

}  // namespace aims
