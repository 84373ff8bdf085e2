// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/ground/ground_constraint.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace aims {
namespace {

/// Correlation length of the tilt of level ground along the path [m].
constexpr double kCorrelationLength = 0.7;

/// Bound on the heights that are kept.
constexpr std::size_t kMaxLevels = 32;

double density(const Eigen::Vector3d& residual, const Eigen::Matrix3d& covariance) {
  const double square = residual.dot(covariance.ldlt().solve(residual));
  return std::exp(-0.5 * std::min(square, 1400.0)) / std::sqrt(covariance.determinant());
}

/// Variances of the slope, twice, and of the height of level ground.
Eigen::Vector3d unevenness(const GroundConstraintConfig& config) {
  const double tilt = config.sigma_tilt() * config.sigma_tilt();
  return {tilt, tilt, config.sigma_height * config.sigma_height};
}

/// The same of a plane that is fitted to ground which bends away from it within half its radius.
Eigen::Vector3d misfit(const GroundPlane& plane) {
  const double slope = 2.0 * plane.bend / kGroundRadius;
  return {slope * slope, slope * slope, 0.25 * plane.bend * plane.bend};
}

/// How much likelier the bend of the ground is on level ground than on a slope that ends within the
/// radius of the fit with the probability `ends`.
double bend_ratio(const GroundConstraintConfig& config, const GroundPlane& plane, double ends) {
  const double level = config.sigma_height * config.sigma_height;
  const double kink = 0.25 * kGroundRadius * config.sigma_slope;
  const double bent = level + kink * kink;
  const double square = plane.bend * plane.bend;
  const double bent_over_level =
      std::exp(0.5 * square / level - 0.5 * square / bent) * std::sqrt(level / bent);
  return 1.0 / (1.0 - ends + ends * bent_over_level);
}

/// Derivative of floor_of() by the filter's error; that of the height by the rotation is of second
/// order.
Matrix3xError jacobian_of(const NominalState& state, const GroundPlane& plane) {
  using E = ErrorState;
  const Eigen::Matrix3d turning = -state.rotation.toRotationMatrix() * hat(plane.normal);
  Matrix3xError jacobian = Matrix3xError::Zero();
  columns(jacobian, E::kRotation).topRows<2>() = turning.topRows<2>();
  jacobian(2, E::kPosition.offset + 2) = 1.0;
  return jacobian;
}

}  // namespace

std::optional<LinearMeasurement> GroundConstraint::measure(
    const Belief& belief, const std::optional<GroundPlane>& plane) {
  plane_ = plane;
  if (!plane) {
    status_ = GroundStatus::kNotFound;
    return std::nullopt;
  }
  tracker_.update(belief.state, *plane);
  distance_since_used_ += tracker_.moved();
  weigh(belief);
  if (status_ != GroundStatus::kLevel) {
    distance_since_used_ = 0.0;
    return std::nullopt;
  }
  last_height_ = tracker_.floor().z();
  if (!measured_) distance_since_used_ = 2.0 * kCorrelationLength;
  if (!(distance_since_used_ > 0.0)) return std::nullopt;  // the same ground again
  measured_ = true;
  const LinearMeasurement m = rows(belief, tracker_.measured());
  distance_since_used_ = 0.0;
  return m;
}

/// The probabilities of the hypotheses, and the most likely level when the floor is level.
void GroundConstraint::weigh(const Belief& belief) {
  const Matrix3xError J = jacobian_of(belief.state, *plane_);
  Eigen::Matrix3d level = tracker_.covariance() + J * belief.covariance * J.transpose();
  level.diagonal() += unevenness(config_);
  Eigen::Matrix3d step = level;
  step(2, 2) += std::pow(config_.sigma_level(), 2);
  Eigen::Matrix3d sloped = step;
  sloped.diagonal().head<2>().array() += std::pow(config_.sigma_slope, 2);

  const double change = std::min(0.5, kGroundRadius / kLevelDistance);
  const Eigen::Vector3d zero_height(tracker_.floor().x(), tracker_.floor().y(), 0.0);
  const double weight_sloped = change * density(zero_height, sloped);
  // A start is on a level that was not met before, or anywhere on a slope. Later the slope begins
  // within the radius.
  const bool start = levels_.empty();
  const double weight_new = (start ? 1.0 - change : change) * density(zero_height, step);
  double weight_known = 0.0;
  double best = 0.0;
  std::optional<std::size_t> nearest;
  for (std::size_t i = 0; i < levels_.size(); ++i) {
    const double prior = !current_        ? (1.0 - change) / static_cast<double>(levels_.size())
                         : i == *current_ ? 1.0 - change
                                          : change;
    const double weight = prior * level_density(i, level);
    weight_known += weight;
    if (weight <= best) continue;
    best = weight;
    nearest = i;
  }
  const double weight_level =
      (weight_known + weight_new) * bend_ratio(config_, *plane_, start ? change : 1.0);
  level_probability_ = weight_level > 0.0 ? weight_level / (weight_level + weight_sloped) : 0.0;
  status_ = level_probability_ > 0.5 ? GroundStatus::kLevel : GroundStatus::kSloped;
  if (status_ == GroundStatus::kSloped) {
    current_.reset();
  } else if (weight_known > weight_new) {
    current_ = nearest;
  } else {
    add_level(belief);
  }
}

/// The current level is tested by what the floor's height changed since the last scan: the drift of
/// the filter's height, however large, is no step.
double GroundConstraint::level_density(std::size_t index, const Eigen::Matrix3d& covariance) const {
  const bool current = current_ && index == *current_;
  Eigen::Matrix3d total = covariance;
  if (!current) total(2, 2) += levels_[index].variance;
  Eigen::Vector3d residual = tracker_.floor();
  residual.z() -= current ? last_height_ : levels_[index].z;
  return density(residual, total);
}

void GroundConstraint::add_level(const Belief& belief) {
  const int up = ErrorState::kPosition.offset + 2;
  if (levels_.size() == kMaxLevels) levels_.erase(levels_.begin());
  current_ = levels_.size();
  levels_.push_back({tracker_.floor().z(), belief.covariance(up, up)});
}

LinearMeasurement GroundConstraint::rows(const Belief& belief, const Eigen::Vector3d& floor) const {
  LinearMeasurement m;
  m.residual = floor;
  m.residual.z() -= levels_[*current_].z;
  m.jacobian = jacobian_of(belief.state, *plane_);
  m.noise = tracker_.noise();
  // Variance of a mean of correlated errors: twice the correlation length over the distance. Not of
  // the height, which must outweigh a map whose own error is as correlated.
  const double samples = std::max(1.0, 2.0 * kCorrelationLength / distance_since_used_);
  m.noise.diagonal() +=
      (unevenness(config_) + misfit(*plane_)).cwiseProduct(Eigen::Vector3d(samples, samples, 1.0));
  m.noise(2, 2) += levels_[*current_].variance;
  m.noise /= level_probability_;
  return m;
}

void GroundConstraint::corrected(const NominalState& state) {
  if (!plane_) return;
  tracker_.shift(floor_of(state, *plane_) - tracker_.measured());
  last_height_ = tracker_.floor().z();
}

Belief with_map_error(const Belief& belief, const Eigen::Matrix3d& map_covariance) {
  using E = ErrorState;
  Belief widened = belief;
  const double height = map_covariance(2, 2);
  const double tilt = height / (kGroundRadius * kGroundRadius);
  widened.covariance(E::kPosition.offset + 2, E::kPosition.offset + 2) += height;
  // Roll and pitch of a body that stands about upright.
  widened.covariance.diagonal().segment<2>(E::kRotation.offset).array() += tilt;
  return widened;
}

Belief with_tilt_of(const Belief& belief, const Belief& start) {
  using E = ErrorState;
  const Eigen::Matrix3d turn = (belief.state.rotation.conjugate() * start.state.rotation).matrix();
  const auto of_start = [&start](E::Block row, E::Block column) {
    return Eigen::Matrix3d(block(start.covariance, row, column));
  };
  const Eigen::Matrix3d with_bias = turn * of_start(E::kRotation, E::kAccelerometerBias);
  Belief widened = belief;
  ErrorMatrix& P = widened.covariance;
  block(P, E::kRotation, E::kRotation) +=
      turn * of_start(E::kRotation, E::kRotation) * turn.transpose();
  block(P, E::kRotation, E::kAccelerometerBias) += with_bias;
  block(P, E::kAccelerometerBias, E::kRotation) += with_bias.transpose();
  block(P, E::kAccelerometerBias, E::kAccelerometerBias) +=
      of_start(E::kAccelerometerBias, E::kAccelerometerBias);
  return widened;
}

Belief fuse_ground(const Belief& belief, const LinearMeasurement& measurement) {
  const Eigen::Matrix3d up = Eigen::Vector3d::UnitZ() * Eigen::Vector3d::UnitZ().transpose();
  return fuse(belief, measurement, {.legs = false, .translation = up});
}

}  // namespace aims
