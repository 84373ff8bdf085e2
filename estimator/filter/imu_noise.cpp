// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/filter/imu_noise.hpp"

#include <algorithm>
#include <cmath>

namespace aims {
namespace {

/// Time over which variances are averaged: a stride [s].
constexpr double kAveragingTime = 0.5;

/// Gain of the quick average: about three samples.
constexpr double kFastGain = 0.3;

/// Scans over which the share of noise is averaged: many strides, far less than a run.
constexpr double kScans = 100.0;
/// Scans for which the first guess of the share counts.
constexpr double kPriorScans = 10.0;
/// Bounds on the share: a filtered IMU of high rate, and a noise that the samples hardly show.
constexpr double kMinShare = 1e-3;
constexpr double kMaxShare = 10.0;

/// What the samples do not show: attitude errors of a map, a milliradian over seconds, let gravity
/// act as 0.01 m/s^2, and scale and axes of a MEMS gyro are wrong by half a percent of 0.5 rad/s.
constexpr ImuNoiseDensity kLeast{2e-3, 5e-2};

/// Correlation time of the motion of a trot, a quarter of its period of 0.4 s [s].
constexpr double kMotionTime = 0.1;

double mean_square(const Eigen::Vector3d& x) { return x.squaredNorm() / 3.0; }

}  // namespace

void SignalStatistics::add(const Eigen::Vector3d& x, bool follows, double gain) {
  if (!follows) count_ = 0;
  if (!started_) mean_ = x;
  started_ = true;
  mean_ += gain * (x - mean_);
  variance_.total += gain * (mean_square(x - mean_) - variance_.total);
  if (count_ == 2) {
    const Eigen::Vector3d difference = x - 2.0 * last_[0] + last_[1];
    const double white = mean_square(difference) / 6.0;
    slow_white_ += gain * (white - slow_white_);
    fast_white_ += kFastGain * (white - fast_white_);
    variance_.white = std::max(slow_white_, fast_white_);
  }
  last_ = {x, last_[0]};
  count_ = std::min(count_ + 1, 2);
}

ImuNoise::ImuNoise(double rate_hz) : period_(1.0 / rate_hz) {}

void ImuNoise::add(const ImuSample& sample) {
  const double since = started_ ? to_seconds(sample.stamp - last_) : period_;
  const bool follows = since > 0.5 * period_ && since < 1.5 * period_;
  const double gain = 1.0 - std::exp(-std::clamp(since, 0.0, kAveragingTime) / kAveragingTime);
  rate_.add(sample.angular_velocity, follows, gain);
  force_.add(sample.specific_force, follows, gain);
  last_ = sample.stamp;
  started_ = true;
}

void NoiseShare::add(double correction, double expected) {
  if (expected_ == 0.0) {
    expected_ = expected * kPriorScans / kScans;
    corrections_ = expected_;
  }
  expected_ += (expected - expected_) / kScans;
  corrections_ += (correction - corrections_) / kScans;
}

double NoiseShare::value() const {
  return expected_ > 0.0 ? std::clamp(corrections_ / expected_, kMinShare, kMaxShare) : 1.0;
}

void ImuNoise::add_correction(double rotation, double velocity, double duration) {
  rate_share_.add(rotation, rate_.variance().white * period_ * duration);
  force_share_.add(velocity, force_.variance().white * period_ * duration);
}

ImuNoiseDensity ImuNoise::density() const {
  return {
      std::max(kLeast.gyro, std::sqrt(rate_share_.value() * period_) * white().rate),
      std::max(kLeast.accelerometer, std::sqrt(force_share_.value() * period_) * white().force)};
}

ImuNoiseDensity ImuNoise::bridge_density() const {
  const ImuNoiseDensity least = density();
  return {std::max(least.gyro, std::sqrt(kMotionTime * rate_.variance().total)),
          std::max(least.accelerometer, std::sqrt(kMotionTime * force_.variance().total))};
}

WhiteDeviation ImuNoise::white() const {
  return {std::sqrt(rate_.variance().white), std::sqrt(force_.variance().white)};
}

}  // namespace aims
