// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "core/time.hpp"

namespace aims {

/// Whether an IMU moves during some time.
class MotionWindow {
 public:
  void add(Time stamp, const Eigen::Vector3d& angular_velocity,
           const Eigen::Vector3d& specific_force) {
    if (samples_ == 0) {
      begin_ = stamp;
      rate_zero_ = angular_velocity;
      force_zero_ = specific_force;
    }
    ++samples_;
    rates_.add(angular_velocity - rate_zero_);
    forces_.add(specific_force - force_zero_);
  }

  /// From the first sample.
  Duration length_to(Time stamp) const { return samples_ == 0 ? 0 : stamp - begin_; }

  /// As no robot that stands does: it turns on average, or its rates or forces vary.
  bool moves() const {
    constexpr double kRate = 0.1, kRateDeviation = 0.03, kForceDeviation = 0.3;  // rad/s, m/s^2
    constexpr int kLeast = 10;                                                   // samples
    if (samples_ < kLeast) return false;
    return (rate_zero_ + rates_.sum / samples_).norm() > kRate ||
           rates_.deviation(samples_) > kRateDeviation ||
           forces_.deviation(samples_) > kForceDeviation;
  }

 private:
  struct Sums {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero(), squares = Eigen::Vector3d::Zero();

    void add(const Eigen::Vector3d& value) {
      sum += value;
      squares += value.cwiseProduct(value);
    }
    /// Standard deviation, of the axis with the largest.
    double deviation(int count) const {
      const Eigen::Vector3d mean = sum / count;
      return (squares / count - mean.cwiseProduct(mean)).cwiseMax(0.0).cwiseSqrt().maxCoeff();
    }
  };

  int samples_ = 0;
  Time begin_ = 0;
  Eigen::Vector3d rate_zero_ = Eigen::Vector3d::Zero(), force_zero_ = Eigen::Vector3d::Zero();
  Sums rates_, forces_;
};

}  // namespace aims
