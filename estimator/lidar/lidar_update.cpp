// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/lidar/lidar_update.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace aims {
namespace {

/// A pose that shifts by less may be that of a robot that stands: no way [m].
constexpr double kLeastWay = 0.05;

/// Smallest eigenvalue and condition number of the translation information that remains when the
/// rotation is unknown too (its Schur complement).
void record_localizability(const Matrix6& information, ScanDiagnostics& diagnostics) {
  const Eigen::Matrix3d translation =
      schur_complement(information.bottomRightCorner<3, 3>(), information.bottomLeftCorner<3, 3>(),
                       information.topLeftCorner<3, 3>());
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(translation, Eigen::EigenvaluesOnly);
  diagnostics.smallest_eigenvalue = std::max(solver.eigenvalues()(0), 0.0);
  diagnostics.condition_number =
      solver.eigenvalues()(2) / std::max(diagnostics.smallest_eigenvalue, 1e-9);
}

}  // namespace

LidarUpdate::LidarUpdate(const EstimatorConfig& config, const FamilyMember& member)
    : lidar_(config.lidar),
      degeneracy_(config.degeneracy),
      directional_(config.directional),
      member_(member),
      axes_(config.directional.spurious),
      severity_(config.degeneracy.alpha) {}

bool LidarUpdate::holds_legs() const {
  const LegStatesConfig& legs = directional_.leg_states;
  return legs.hold && axes_.position().proven().minCoeff() < legs.trusted;
}

ErrorMatrix LidarUpdate::scan_mask() const {
  const ErrorMatrix mask = holds_legs() ? hold_legs(correct_all()) : correct_all();
  const BlockWeights& position = axes_.position();
  return hold_motion(mask, position.axes * position.taken.asDiagonal() * position.axes.transpose());
}

void LidarUpdate::associate(const NominalState& state, std::span<const Eigen::Vector3f> points,
                            const VoxelMap& map) {
  matches_.clear();
  const Eigen::Matrix3f R = state.rotation.toRotationMatrix().cast<float>();
  const Eigen::Vector3f t = state.position.cast<float>();
  for (const Eigen::Vector3f& point : points) {
    const Plane plane = map.plane_at(R * point + t);
    if (plane.valid) matches_.push_back({point.cast<double>(), plane});
  }
}

LidarUpdate::Linearization LidarUpdate::linearize(const NominalState& state) {
  Linearization sum;
  residuals_.clear();
  const Eigen::Matrix3d R = state.rotation.toRotationMatrix();
  for (const Match& match : matches_) {
    const PlaneRow row = plane_row(match.plane, match.p_body, R, state.position);
    if (!(std::abs(row.residual) <= lidar_.residual_gate)) continue;
    const double ratio = row.residual / robust_scale_;
    const double weight = 1.0 / (1.0 + ratio * ratio);  // Cauchy
    const Vector6 weighted = weight * row.jacobian;
    sum.matrix.noalias() += weighted * row.jacobian.transpose();
    sum.vector.noalias() += weighted * row.residual;
    if (member_.directional) {
      sum.chance += weight * chance_information(match.plane.normal_covariance, match.p_body, R);
    }
    residuals_.push_back(row.residual);
  }
  const double weight = 1.0 / (lidar_.point_sigma * lidar_.point_sigma);
  sum.matrix *= weight;
  sum.vector *= weight;
  sum.chance *= weight;
  sum.used = static_cast<int>(residuals_.size());
  return sum;
}

/// From the residuals of the last linearisation: their robust deviation, from the median of their
/// magnitudes, times `RobustConfig::scale`.
void LidarUpdate::set_robust_scale() {
  if (!directional_.robust.enabled || residuals_.empty()) return;
  magnitudes_.clear();
  for (const double residual : residuals_) magnitudes_.push_back(std::abs(residual));
  const auto middle = magnitudes_.begin() + static_cast<std::ptrdiff_t>(magnitudes_.size() / 2);
  std::nth_element(magnitudes_.begin(), middle, magnitudes_.end());
  constexpr double kDeviationsOfMedian = 0.6745;  // of a normal distribution's magnitude
  const double deviation = std::max(*middle / kDeviationsOfMedian, directional_.robust.least);
  robust_scale_ = directional_.robust.scale * deviation;
}

void LidarUpdate::assess_axes(const Linearization& rows, const NominalState& state,
                              ScanDiagnostics& diagnostics) {
  const double way = last_position_ ? (state.position - *last_position_).norm() : 0.0;
  const bool went = !last_position_ || way >= kLeastWay;
  if (went) last_position_ = state.position;
  axes_.assess(rows.matrix, rows.chance, state.rotation.toRotationMatrix(), went ? way : 0.0);
  diagnostics.weak_weight = axes_.position().proven().minCoeff();
  diagnostics.weak_ratio = axes_.position().ratio.minCoeff();
}

Information LidarUpdate::weighed(const Linearization& rows, double gamma,
                                 const NominalState& state) const {
  if (!directional_.spurious.enabled) {
    return pose_information(gamma * rows.matrix, gamma * rows.vector);
  }
  const KeptOfScan kept = axes_.kept(state.rotation.toRotationMatrix());
  return pose_information(kept.T * rows.matrix * kept.T, kept.P * rows.vector);
}

Belief LidarUpdate::correct(const Belief& predicted, const ErrorMatrix& prior_information,
                            const NominalState& linearization, const Linearization& rows,
                            double gamma) const {
  const Information information = weighed(rows, gamma, linearization);
  if (!directional_.spurious.enabled) {
    return kalman_update(predicted.state, prior_information, linearization, information);
  }
  return kalman_update(predicted.state, prior_information, linearization, information, scan_mask());
}

bool LidarUpdate::moved(const NominalState& state, const NominalState& since, double rotation,
                        double position) const {
  return state.rotation.angularDistance(since.rotation) > rotation ||
         (state.position - since.position).norm() > position;
}

Belief LidarUpdate::trial(const Belief& predicted, const ErrorMatrix& prior_information,
                          std::span<const Eigen::Vector3f> points, const VoxelMap& map,
                          ScanDiagnostics& diagnostics) {
  robust_scale_ = kNotRobust;
  Belief belief = predicted;
  NominalState associated_at = predicted.state;
  associate(associated_at, points, map);
  for (int i = 0; i < lidar_.max_iterations; ++i) {
    if (moved(belief.state, associated_at, lidar_.research_rotation, lidar_.research_position)) {
      associated_at = belief.state;
      associate(associated_at, points, map);
    }
    const Linearization rows = linearize(belief.state);
    if (i == 0) {
      diagnostics.residual_sigma_prior = std::sqrt(residual_statistics(residuals_).variance);
    }
    diagnostics.points_used = rows.used;
    if (rows.used < lidar_.min_matches) return predicted;
    const NominalState before = belief.state;
    set_robust_scale();
    if (i == 0 && member_.directional) assess_axes(rows, before, diagnostics);
    belief = correct(predicted, prior_information, before, rows, 1.0);
    ++diagnostics.iterations;
    if (!moved(belief.state, before, lidar_.convergence_rotation, lidar_.convergence_position)) {
      break;
    }
  }
  return belief;
}

void LidarUpdate::assess(const Belief& predicted, const ErrorMatrix& prior_information,
                         const NominalState& trial_state, ScanDiagnostics& diagnostics) {
  const ResidualStatistics statistics = residual_statistics(residuals_);
  const double prior_sigma = diagnostics.residual_sigma_prior;
  const ErrorVector y = boxminus(trial_state, predicted.state);  // eq. (5)
  diagnostics.residual_mean = statistics.mean;
  diagnostics.residual_sigma = std::sqrt(statistics.variance);
  diagnostics.O_lidar = effective_observability(statistics.variance, degeneracy_.sigma_0);
  diagnostics.O_lidar_prior =
      effective_observability(prior_sigma * prior_sigma, degeneracy_.sigma_0);
  diagnostics.C_IL = consistency(pose_segment(y), pose_block(predicted.covariance));
  diagnostics.C_IL_full = consistency_full(y, prior_information);
  diagnostics.innovation_rotation = segment(y, ErrorState::kRotation);
  diagnostics.innovation_position = segment(y, ErrorState::kPosition);
  const double O_lidar =
      degeneracy_.prior_residuals ? diagnostics.O_lidar_prior : diagnostics.O_lidar;
  diagnostics.D = degeneracy_severity(O_lidar, diagnostics.C_IL, degeneracy_);  // eq. (7)
  severity_.update(diagnostics.D);                                              // eq. (12)
}

void LidarUpdate::rest_on(const VoxelMap& map, const Belief& predicted, const Belief& updated) {
  anchored_.clear();
  for (const Match& match : matches_) {
    const Eigen::Vector3d place = updated.state.T_odom_body() * match.p_body;
    anchored_.push_back({match.plane.normal, map.anchor_at(place.cast<float>()).cast<double>()});
  }
  const auto position = [](const Belief& belief) {
    return Eigen::Matrix3d(block(belief.covariance, ErrorState::kPosition, ErrorState::kPosition));
  };
  map_anchor_ = anchor_after_scan(map_anchor_, position(predicted), position(updated), anchored_);
}

Belief LidarUpdate::update(const Belief& predicted, std::span<const Eigen::Vector3f> points,
                           const VoxelMap& map, ScanDiagnostics& diagnostics) {
  const ErrorMatrix prior_information = inverse_spd(predicted.covariance);
  Belief belief = trial(predicted, prior_information, points, map, diagnostics);
  const bool matched = diagnostics.points_used >= lidar_.min_matches;
  if (matched) {
    const Linearization rows = linearize(belief.state);
    diagnostics.points_used = rows.used;
    record_localizability(rows.matrix, diagnostics);
    assess(predicted, prior_information, belief.state, diagnostics);
    gamma_lidar_ = member_.adaptive ? lidar_reliability(severity_.value(), degeneracy_) : 1.0;
    gamma_leg_ = member_.adaptive ? leg_reliability(severity_.value(), degeneracy_) : 1.0;
    // eq. (9): R_lidar' = R_lidar / gamma_lidar, so the information of the trial's last
    // linearisation is multiplied by gamma_lidar.
    belief = correct(predicted, prior_information, belief.state, rows, gamma_lidar_);
    if (member_.directional) rest_on(map, predicted, belief);
  }
  diagnostics.D_smoothed = severity_.value();
  diagnostics.gamma_lidar = gamma_lidar_;
  diagnostics.gamma_leg = gamma_leg_;
  return belief;
}

}  // namespace aims
