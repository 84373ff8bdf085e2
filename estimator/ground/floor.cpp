// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/ground/floor.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace aims {
namespace {

/// Heights that are remembered.
constexpr std::size_t kMostLevels = 32;
/// Deviations beyond which a floor is another than expected.
constexpr double kGate = 3.0;
/// Force that the mean over a standing start leaves unexplained [m/s^2].
constexpr double kMeanForceError = 5e-3;

/// Variance of the tilt of the floor's normal, the larger axis [rad^2].
double tilt_variance(const Belief& belief, const Eigen::Matrix3d& R) {
  const Eigen::Matrix3d rotation =
      R * block(belief.covariance, ErrorState::kRotation, ErrorState::kRotation) * R.transpose();
  return std::max(rotation(0, 0), rotation(1, 1));
}

}  // namespace

std::optional<LinearMeasurement> FloorConstraint::measure(const Belief& predicted,
                                                          const std::optional<FloorPlane>& seen) {
  const Eigen::Vector3d& position = predicted.state.position;
  const double moved = last_position_ ? (position - *last_position_).norm() : 0.0;
  last_position_ = position;
  way_since_used_ += moved;
  if (!seen) {
    verdict_ = FloorVerdict::kUnseen;
    return std::nullopt;
  }
  const double vertical = (predicted.state.rotation * seen->normal).z();
  const double z = position.z() - seen->height / std::max(vertical, 0.5);
  const bool first = levels_.empty() && !was_level_ && !trusted_;
  level_way_ = was_level_ ? level_way_ + moved : 0.0;
  verdict_ = judge(predicted, *seen, z);
  was_level_ = verdict_ != FloorVerdict::kNotLevel;
  if (!was_level_) {
    trusted_ = false;
    return std::nullopt;
  }
  if (!trusted_) {
    if (!first && level_way_ < config_.settle) {
      verdict_ = FloorVerdict::kWaiting;
      return std::nullopt;
    }
    take_level(predicted, z);
    trusted_ = true;
    way_since_used_ = first ? config_.correlation_length : 0.0;
  }
  if (way_since_used_ < config_.spacing) return std::nullopt;
  // Twice the length over the spacing: the variance of a mean of so correlated errors.
  const double repeats =
      first ? 1.0 : std::max(1.0, 2.0 * config_.correlation_length / way_since_used_);
  way_since_used_ = 0.0;
  return rows(predicted, *seen, z, repeats);
}

FloorVerdict FloorConstraint::judge(const Belief& predicted, const FloorPlane& floor, double z) {
  const Eigen::Matrix3d R = predicted.state.rotation.toRotationMatrix();
  const double tilt = (R * floor.normal).head<2>().norm();
  const double expected =
      std::sqrt(config_.sigma_tilt * config_.sigma_tilt + tilt_variance(predicted, R));
  const double gate = std::clamp(kGate * expected, config_.tilt, config_.max_tilt);
  if (tilt > gate || floor.bend > config_.bend) return FloorVerdict::kNotLevel;
  if (trusted_ && std::abs(z - levels_[current_].z) > config_.step) return FloorVerdict::kNotLevel;
  return FloorVerdict::kLevel;
}

void FloorConstraint::take_level(const Belief& predicted, double z) {
  const int up = ErrorState::kPosition.offset + 2;
  const double variance = predicted.covariance(up, up);
  std::size_t best = levels_.size();
  double least = config_.step;
  for (std::size_t i = 0; i < levels_.size(); ++i) {
    const double off = std::abs(z - levels_[i].z);
    if (off >= least) continue;
    least = off;
    best = i;
  }
  current_ = best;
  if (best < levels_.size()) return;
  if (levels_.size() == kMostLevels) levels_.erase(levels_.begin());
  current_ = levels_.size();
  levels_.push_back({z, variance});
}

LinearMeasurement FloorConstraint::rows(const Belief& predicted, const FloorPlane& floor, double z,
                                        double repeats) const {
  using E = ErrorState;
  const Eigen::Matrix3d R = predicted.state.rotation.toRotationMatrix();
  const Eigen::Matrix3d turning = -R * hat(floor.normal);
  LinearMeasurement m;
  m.residual.head<2>() = (R * floor.normal).head<2>();
  m.residual.z() = z - levels_[current_].z;
  columns(m.jacobian, E::kRotation).topRows<2>() = turning.topRows<2>();
  m.jacobian(2, E::kPosition.offset + 2) = 1.0;
  const Eigen::Matrix3d normal = R * floor.normal_covariance * R.transpose();
  m.noise.setZero();
  m.noise.topLeftCorner<2, 2>() =
      repeats * config_.sigma_tilt * config_.sigma_tilt * Eigen::Matrix2d::Identity() +
      normal.topLeftCorner<2, 2>();
  m.noise(2, 2) =
      repeats * (config_.sigma_height * config_.sigma_height + levels_[current_].variance);
  return m;
}

Belief fuse_floor(const Belief& predicted, const LinearMeasurement& measurement) {
  const Eigen::Matrix3d up = Eigen::Vector3d::UnitZ() * Eigen::Vector3d::UnitZ().transpose();
  return kalman_update(predicted.state, inverse_spd(predicted.covariance), predicted.state,
                       information_of(measurement), hold_motion(hold_legs(correct_all()), up));
}

Belief join_tilt_and_bias(Belief belief, double gravity) {
  using E = ErrorState;
  ErrorMatrix& P = belief.covariance;
  const Eigen::Vector3d up = belief.state.rotation.conjugate() * Eigen::Vector3d::UnitZ();
  // The mean force is R^T g + b and was turned upward: b = -g (up x d_rotation), to first order.
  const Eigen::Matrix3d J = -gravity * hat(up);
  const Eigen::Matrix3d rotation = block(P, E::kRotation, E::kRotation);
  const double vertical = up.dot(block(P, E::kAccelerometerBias, E::kAccelerometerBias) * up);
  block(P, E::kAccelerometerBias, E::kRotation) = J * rotation;
  block(P, E::kRotation, E::kAccelerometerBias) = rotation * J.transpose();
  block(P, E::kAccelerometerBias, E::kAccelerometerBias) =
      J * rotation * J.transpose() + vertical * up * up.transpose() +
      kMeanForceError * kMeanForceError * Eigen::Matrix3d::Identity();
  return belief;
}

}  // namespace aims
