// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/ground/ground_constraint.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace aims {
namespace {

/// Bound on the heights that are kept.
constexpr std::size_t kMaxLevels = 32;
/// Gate of the level test [standard deviations].
constexpr double kGate = 3.0;

/// Variance of the tilt, the larger of roll and pitch [rad^2].
double tilt_variance(const Belief& belief, const Eigen::Matrix3d& R) {
  const Eigen::Matrix3d rotation =
      R * block(belief.covariance, ErrorState::kRotation, ErrorState::kRotation) * R.transpose();
  return std::max(rotation(0, 0), rotation(1, 1));
}

}  // namespace

std::optional<LinearMeasurement> GroundConstraint::measure(
    const Belief& predicted, const std::optional<GroundPlane>& plane) {
  const Eigen::Vector3d& position = predicted.state.position;
  const double moved = last_position_ ? (position - *last_position_).norm() : 0.0;
  last_position_ = position;
  distance_since_used_ += moved;
  if (!plane) {
    status_ = GroundStatus::kNotFound;
    return std::nullopt;
  }
  const double vertical = (predicted.state.rotation * plane->normal).z();
  const double z = position.z() - plane->height / std::max(vertical, 0.5);
  const bool first = levels_.empty() && !was_level_ && !in_use_;
  level_distance_ = was_level_ ? level_distance_ + moved : 0.0;
  status_ = test_level(predicted, *plane, z);
  was_level_ = status_ != GroundStatus::kNotLevel;
  if (!was_level_) {
    in_use_ = false;
    return std::nullopt;
  }
  if (!settled(predicted, z, first)) return std::nullopt;
  if (distance_since_used_ < config_.spacing) return std::nullopt;
  // Variance of a mean of correlated errors: twice the correlation length over the spacing.
  const double correlated_samples =
      first ? 1.0 : std::max(1.0, 2.0 * config_.correlation_length / distance_since_used_);
  distance_since_used_ = 0.0;
  return rows(predicted, *plane, z, correlated_samples);
}

bool GroundConstraint::settled(const Belief& predicted, double z, bool first) {
  if (in_use_) return true;
  if (!first && level_distance_ < config_.settling_distance) {
    status_ = GroundStatus::kSettling;
    return false;
  }
  select_level(predicted, z);
  in_use_ = true;
  distance_since_used_ = first ? config_.correlation_length : 0.0;
  return true;
}

GroundStatus GroundConstraint::test_level(const Belief& predicted, const GroundPlane& plane,
                                          double z) const {
  const Eigen::Matrix3d R = predicted.state.rotation.toRotationMatrix();
  const double tilt = (R * plane.normal).head<2>().norm();
  const double expected =
      std::sqrt(config_.sigma_tilt * config_.sigma_tilt + tilt_variance(predicted, R));
  const double gate = std::clamp(kGate * expected, config_.min_tilt_gate, config_.max_tilt_gate);
  if (tilt > gate || plane.bend > config_.max_bend) return GroundStatus::kNotLevel;
  const bool step = in_use_ && std::abs(z - levels_[current_].z) > config_.max_step;
  return step ? GroundStatus::kNotLevel : GroundStatus::kLevel;
}

/// The known level nearest to `z` within `max_step`, else a new one.
void GroundConstraint::select_level(const Belief& predicted, double z) {
  const int up = ErrorState::kPosition.offset + 2;
  const double variance = predicted.covariance(up, up);
  std::size_t best = levels_.size();
  double nearest = config_.max_step;
  for (std::size_t i = 0; i < levels_.size(); ++i) {
    const double distance = std::abs(z - levels_[i].z);
    if (distance >= nearest) continue;
    nearest = distance;
    best = i;
  }
  current_ = best;
  if (best < levels_.size()) return;
  if (levels_.size() == kMaxLevels) levels_.erase(levels_.begin());
  current_ = levels_.size();
  levels_.push_back({z, variance});
}

LinearMeasurement GroundConstraint::rows(const Belief& predicted, const GroundPlane& plane,
                                         double z, double correlated_samples) const {
  using E = ErrorState;
  const Eigen::Matrix3d R = predicted.state.rotation.toRotationMatrix();
  const Eigen::Matrix3d turning = -R * hat(plane.normal);
  LinearMeasurement m;
  m.residual.head<2>() = (R * plane.normal).head<2>();
  m.residual.z() = z - levels_[current_].z;
  columns(m.jacobian, E::kRotation).topRows<2>() = turning.topRows<2>();
  m.jacobian(2, E::kPosition.offset + 2) = 1.0;
  const Eigen::Matrix3d normal = R * plane.normal_covariance * R.transpose();
  m.noise.setZero();
  m.noise.topLeftCorner<2, 2>() =
      correlated_samples * config_.sigma_tilt * config_.sigma_tilt * Eigen::Matrix2d::Identity() +
      normal.topLeftCorner<2, 2>();
  m.noise(2, 2) = correlated_samples *
                  (config_.sigma_height * config_.sigma_height + levels_[current_].variance);
  return m;
}

Belief fuse_ground(const Belief& predicted, const LinearMeasurement& measurement) {
  const Eigen::Matrix3d up = Eigen::Vector3d::UnitZ() * Eigen::Vector3d::UnitZ().transpose();
  return kalman_update(predicted.state, inverse_spd(predicted.covariance), predicted.state,
                       information_of(measurement), limit_motion(consider_legs(correct_all()), up));
}

}  // namespace aims
