// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/ground/ground_constraint.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <array>
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

namespace {

/// Correlation length of the tilt of level ground along the path [m].
constexpr double kCorrelationLength = 0.7;

/// Prior probability of a change of the floor within the radius of the fit.
constexpr double kChange = kGroundRadius / kLevelDistance;

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

/// The symmetric matrix without its negative eigenvalues.
Matrix6 positive_part(const Matrix6& symmetric) {
  const Eigen::SelfAdjointEigenSolver<Matrix6> solver(symmetric);
  const auto& axes = solver.eigenvectors();
  return axes * solver.eigenvalues().cwiseMax(0.0).asDiagonal() * axes.transpose();
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
  if (!(distance_since_used_ > 0.0)) return std::nullopt;  // the same ground again
  const LinearMeasurement m = rows(belief, tracker_.measured());
  distance_since_used_ = 0.0;
  return m;
}

/// The probabilities of the hypotheses, and the most likely level when the floor is level. Gravity
/// shows that the start was a slope: the accelerometer then agrees with this floor, not with that
/// of the start.
void GroundConstraint::weigh(const Belief& belief) {
  const Matrix3xError J = jacobian_of(belief.state, *plane_);
  Eigen::Matrix3d level = tracker_.covariance() + J * belief.covariance * J.transpose();
  level.diagonal() += unevenness(config_);
  Eigen::Matrix3d step = level;
  step(2, 2) += std::pow(config_.sigma_level(), 2);
  Eigen::Matrix3d sloped = step;
  sloped.diagonal().head<2>().array() += std::pow(config_.sigma_slope, 2);

  const Eigen::Vector3d zero_height(tracker_.floor().x(), tracker_.floor().y(), 0.0);
  const double weight_sloped = kChange * density(zero_height, sloped);
  // A start is on a level that was not met before, or anywhere on a slope. Later the slope begins
  // within the radius.
  const bool start = levels_.empty();
  const double weight_new = (start ? 1.0 - kChange : kChange) * density(zero_height, step);
  const KnownLevels known = known_levels(level);
  const double weight_level =
      (known.weight + weight_new) * bend_ratio(config_, *plane_, start ? kChange : 1.0);
  level_probability_ = weight_level > 0.0 ? weight_level / (weight_level + weight_sloped) : 0.0;
  status_ = level_probability_ > 0.5 ? GroundStatus::kLevel : GroundStatus::kSloped;
  const double weight_start = sloped_start_weight(belief, step);
  start_was_sloped_ = weight_start > weight_level + weight_sloped;
  if (start_was_sloped_) {
    level_probability_ = weight_start / (weight_start + weight_level + weight_sloped);
    status_ = GroundStatus::kLevel;
    start_.reset();
    start_again(belief);
  } else if (start && status_ == GroundStatus::kLevel) {
    start_ = start_of(belief, weight_sloped / weight_level, level.topLeftCorner<2, 2>());
    start_again(belief);
  } else if (status_ == GroundStatus::kSloped) {
    current_.reset();
  } else if (known.weight > weight_new) {
    current_ = known.likeliest;
  } else {
    add_level(belief);
  }
}

/// `covariance` is that of a level floor at a known height.
GroundConstraint::KnownLevels GroundConstraint::known_levels(
    const Eigen::Matrix3d& covariance) const {
  KnownLevels known;
  double largest = 0.0;
  for (std::size_t i = 0; i < levels_.size(); ++i) {
    const double prior = !current_        ? (1.0 - kChange) / static_cast<double>(levels_.size())
                         : i == *current_ ? 1.0 - kChange
                                          : kChange;
    const double weight = prior * level_density(i, covariance);
    known.weight += weight;
    if (weight <= largest) continue;
    largest = weight;
    known.likeliest = i;
  }
  return known;
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

/// Weight of a start that was a slope and of a level floor here, of which it is in view.
/// `covariance` is that of a level floor at any height.
double GroundConstraint::sloped_start_weight(const Belief& belief,
                                             const Eigen::Matrix3d& covariance) const {
  if (!start_ || (belief.state.position - start_->position).norm() > kLevelDistance) return 0.0;
  Eigen::Matrix3d total = covariance;
  const Eigen::Vector2d lag = (tracker_.measured() - tracker_.floor()).head<2>();
  total.topLeftCorner<2, 2>() += start_->covariance + lag * lag.transpose();
  Eigen::Vector3d residual = Eigen::Vector3d::Zero();
  residual.head<2>() = tracker_.floor().head<2>() + start_->slope;
  return start_->odds * kChange * density(residual, total) * bend_ratio(config_, *plane_, kChange);
}

/// The start as a slope, with the prior of slopes. `tilt`: covariance of a level floor.
GroundConstraint::Start GroundConstraint::start_of(const Belief& belief, double odds,
                                                   const Eigen::Matrix2d& tilt) const {
  const Eigen::Matrix2d prior = std::pow(config_.sigma_slope, 2) * Eigen::Matrix2d::Identity();
  const Eigen::Matrix2d gain = prior * (prior + tilt).inverse();
  return {belief.state.position, odds, gain * tracker_.floor().head<2>(), gain * tilt};
}

/// The floor of the last scan is the first level, and what was tracked before it is not level.
void GroundConstraint::start_again(const Belief& belief) {
  tracker_ = FloorTracker(config_);
  tracker_.update(belief.state, *plane_);
  distance_since_used_ = 2.0 * kCorrelationLength;
  levels_.clear();
  add_level(belief);
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

void GroundConstraint::corrected(const NominalState& state, bool start) {
  if (!plane_) return;
  tracker_.shift(floor_of(state, *plane_) - tracker_.measured());
  last_height_ = tracker_.floor().z();
  if (start) levels_[*current_].z = last_height_;
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
  constexpr int kR = ErrorState::kRotation.offset;
  constexpr int kB = ErrorState::kAccelerometerBias.offset;
  constexpr std::array kStates = {kR, kR + 1, kR + 2, kB, kB + 1, kB + 2};
  // The tilt is fixed in the odometry frame, the bias in the body.
  Matrix6 turn = Matrix6::Identity();
  turn.topLeftCorner<3, 3>() = (belief.state.rotation.conjugate() * start.state.rotation).matrix();
  const Matrix6 at_start = turn * start.covariance(kStates, kStates) * turn.transpose();
  Belief widened = belief;
  widened.covariance(kStates, kStates) +=
      positive_part(at_start - belief.covariance(kStates, kStates));
  return widened;
}

Belief with_turned_path(Belief belief, const NominalState& before, const NominalState& start) {
  const Eigen::Quaterniond turn = belief.state.rotation * before.rotation.conjugate();
  belief.state.position = start.position + turn * (before.position - start.position);
  belief.state.velocity = turn * before.velocity;
  return belief;
}

Belief fuse_ground(const Belief& belief, const LinearMeasurement& measurement) {
  const Eigen::Matrix3d up = Eigen::Vector3d::UnitZ() * Eigen::Vector3d::UnitZ().transpose();
  return fuse(belief, measurement, {.legs = false, .translation = up});
}

}  // namespace aims
