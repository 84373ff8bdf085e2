// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/ground/floor_tracker.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace aims {
namespace {

/// Scans in the average of the noise: 2 s at 10 Hz, several strides.
constexpr double kNoiseScans = 20.0;

Eigen::Matrix3d variances(double slope, double height) {
  return Eigen::Vector3d(slope * slope, slope * slope, height * height).asDiagonal();
}

}  // namespace

Eigen::Vector3d floor_of(const NominalState& state, const GroundPlane& plane) {
  const Eigen::Vector3d normal = state.rotation * plane.normal;
  return {normal.x(), normal.y(), state.position.z() - plane.height / std::max(normal.z(), 0.5)};
}

void FloorTracker::update(const NominalState& state, const GroundPlane& plane) {
  const Eigen::Vector3d measured = floor_of(state, plane);
  estimate_noise(measured, plane, state.rotation.toRotationMatrix());
  const Eigen::Vector3d motion =
      started_ ? Eigen::Vector3d(state.position - position_) : Eigen::Vector3d::Zero();
  position_ = state.position;
  moved_ = motion.norm();
  measured_ = measured;
  if (!started_) {
    started_ = true;
    floor_ = measured;
    covariance_ = noise_;
    return;
  }
  Eigen::Matrix3d F = Eigen::Matrix3d::Identity();
  F.row(2).head<2>() = -motion.head<2>().transpose();  // a floor z = -(n_x x + n_y y)
  floor_ = F * floor_;
  const double bends = moved_ / kLevelDistance;
  covariance_ = F * covariance_ * F.transpose() +
                bends * variances(config_.sigma_slope, config_.sigma_level());
  const Eigen::Matrix3d gain = covariance_ * (covariance_ + noise_).inverse();
  floor_ += gain * (measured - floor_);
  covariance_ = (Eigen::Matrix3d::Identity() - gain) * covariance_;
  covariance_ = 0.5 * (covariance_ + covariance_.transpose().eval());
}

/// Half the mean square of the differences of consecutive scans, about the plane's own covariance.
void FloorTracker::estimate_noise(const Eigen::Vector3d& measured, const GroundPlane& plane,
                                  const Eigen::Matrix3d& R) {
  if (started_) {
    const Eigen::Vector3d difference = measured - measured_;
    const double forget = 1.0 - 1.0 / kNoiseScans;
    differences_ = forget * differences_ + 1.0;
    slope_square_ = forget * slope_square_ + 0.25 * difference.head<2>().squaredNorm();
    height_square_ = forget * height_square_ + 0.5 * difference.z() * difference.z();
  }
  noise_.setZero();
  noise_.topLeftCorner<2, 2>() +=
      (R * plane.normal_covariance * R.transpose()).topLeftCorner<2, 2>();
  noise_(2, 2) += plane.height_variance;
  if (differences_ > 0.0) {
    noise_ += variances(std::sqrt(slope_square_ / differences_),
                        std::sqrt(height_square_ / differences_));
  }
}

void FloorTracker::shift(const Eigen::Vector3d& shift) {
  floor_ += shift;
  measured_ += shift;
}

}  // namespace aims
