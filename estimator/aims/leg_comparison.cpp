// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/aims/leg_comparison.hpp"

#include <algorithm>
#include <cmath>

namespace aims {
namespace {

constexpr double kWalking = 0.2;  ///< least speed [m/s]
constexpr double kTurning = 0.2;  ///< a faster turn is no straight way [rad/s]

/// Pieces of the way, longer than what a stride or a door does to it [m].
constexpr double kPiece = 5.0;
constexpr int kLeastPieces = 4;

/// Deviation of the scale that ground and load leave, however long the way [-].
constexpr double kLeastSigma = 3e-3;

Eigen::Vector3d ahead(const NominalState& state) {
  Eigen::Vector3d axis = state.rotation * Eigen::Vector3d::UnitX();
  axis.z() = 0.0;
  return axis.normalized();
}

}  // namespace

void LegComparison::add(const NominalState& by_legs, const NominalState& by_scans, double dt,
                        bool constrained) {
  if (last_constrained_ && constrained && dt > 0.0) {
    const Eigen::Vector3d axis = ahead(last_by_scans_);
    const double scans = axis.dot(by_scans.position - last_by_scans_.position);
    const double legs = axis.dot(by_legs.position - last_by_legs_.position);
    const double turn = axis.cross(ahead(by_scans)).norm();  // trunks also roll and pitch
    if (scans > kWalking * dt && turn < kTurning * dt) {
      time_ += dt;
      legs_ += legs;
      scans_ += scans;
      piece_legs_ += legs;
      piece_scans_ += scans;
    }
  }
  last_by_legs_ = by_legs;
  last_by_scans_ = by_scans;
  last_constrained_ = constrained;
  if (piece_scans_ < kPiece) return;
  const double ratio = piece_legs_ / piece_scans_;
  const double before = ratio - mean_ratio_;
  mean_ratio_ += before / ++pieces_;
  square_of_ratio_ += before * (ratio - mean_ratio_);
  piece_legs_ = piece_scans_ = 0.0;
}

/// Of the row's z [m^2/s^2].
double LegComparison::variance() const {
  const double speed = scans_ / time_;
  const double of_mean = square_of_ratio_ / (pieces_ - 1.0) / pieces_;
  return speed * speed * (of_mean + kLeastSigma * kLeastSigma);
}

Eigen::MatrixXd LegComparison::information() const {
  Eigen::MatrixXd information = Eigen::MatrixXd::Zero(6, 6);
  if (pieces_ < kLeastPieces) return information;
  Eigen::VectorXd row = Eigen::VectorXd::Zero(6);
  row(0) = scans_ / time_;
  row(3) = 1.0;
  return row * row.transpose() / variance();
}

Eigen::VectorXd LegComparison::vector(const NominalState& state) const {
  Eigen::VectorXd vector = Eigen::VectorXd::Zero(6);
  if (pieces_ < kLeastPieces) return vector;
  const double speed = scans_ / time_;
  const double reported = legs_ / time_ * (1.0 + state.leg_scale.x()) + state.leg_bias.x();
  vector(0) = speed;
  vector(3) = 1.0;
  return (reported - speed) / variance() * vector;
}

}  // namespace aims
