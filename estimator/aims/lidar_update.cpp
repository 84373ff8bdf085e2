// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/aims/lidar_update.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "estimator/aims/leg_free_prediction.hpp"

namespace aims {
namespace {

/// Smaller shifts between scans count as standing [m].
constexpr double kMinShift = 0.05;

/// Smallest eigenvalue and condition number of the translation information with unknown rotation
/// (its Schur complement).
void record_localizability(const Matrix6& information, ScanDiagnostics& diagnostics) {
  const Eigen::Matrix3d translation =
      schur_complement(information.bottomRightCorner<3, 3>(), information.bottomLeftCorner<3, 3>(),
                       information.topLeftCorner<3, 3>());
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(translation, Eigen::EigenvaluesOnly);
  diagnostics.smallest_eigenvalue = std::max(solver.eigenvalues()(0), 0.0);
  diagnostics.condition_number =
      solver.eigenvalues()(2) / std::max(diagnostics.smallest_eigenvalue, 1e-9);
}

/// Whether the pose changed by more than `rotation` [rad] or `position` [m].
bool moved(const NominalState& state, const NominalState& since, double rotation, double position) {
  return state.rotation.angularDistance(since.rotation) > rotation ||
         (state.position - since.position).norm() > position;
}

}  // namespace

LidarUpdate::LidarUpdate(const EstimatorConfig& config, const EstimatorVariant& variant)
    : lidar_(config.lidar),
      degeneracy_(config.degeneracy),
      noise_information_(config.directional.noise_information),
      leg_states_(config.directional.leg_states),
      variant_(variant),
      matcher_(config.lidar, config.directional.robust_kernel, variant.directional),
      axes_(config.directional.noise_information),
      severity_(config.degeneracy.alpha) {}

bool LidarUpdate::considers_legs() const {
  return leg_states_.gate_learning &&
         axes_.position().significant().minCoeff() < leg_states_.min_axis_weight;
}

/// No correction along unobservable axes, whatever their correlation with the observable ones.
ErrorMatrix LidarUpdate::gain_mask() const {
  const ErrorMatrix mask = considers_legs() ? consider_legs(correct_all()) : correct_all();
  const AxisWeights& position = axes_.position();
  return limit_motion(mask,
                      position.axes * position.acceptance.asDiagonal() * position.axes.transpose());
}

void LidarUpdate::assess_axes(const ScanInformation& scan, const NominalState& state,
                              ScanDiagnostics& diagnostics) {
  const double shift = last_position_ ? (state.position - *last_position_).norm() : 0.0;
  const bool shifted = !last_position_ || shift >= kMinShift;
  if (shifted) last_position_ = state.position;
  axes_.assess(scan.matrix, scan.noise, state.rotation.toRotationMatrix(), shifted ? shift : 0.0);
  diagnostics.weak_weight = axes_.position().significant().minCoeff();
  diagnostics.weak_ratio = axes_.position().ratio.minCoeff();
}

/// The information of the scan as it is fused: eq. (9), R_lidar' = R_lidar / gamma_lidar,
/// multiplies it by gamma_lidar; the directional variant scales it per axis.
Information LidarUpdate::scaled(const ScanInformation& scan, double gamma,
                                const NominalState& state) const {
  if (!noise_information_.enabled) {
    return pose_information(gamma * scan.matrix, gamma * scan.vector);
  }
  const ScanScale scale = axes_.scale(state.rotation.toRotationMatrix());
  return pose_information(scale.T * scan.matrix * scale.T, scale.P * scan.vector);
}

Belief LidarUpdate::correct(const Belief& predicted, const ErrorMatrix& prior_information,
                            const NominalState& linearization, const ScanInformation& scan,
                            double gamma) const {
  const Information information = scaled(scan, gamma, linearization);
  if (!noise_information_.enabled) {
    return kalman_update(predicted.state, prior_information, linearization, information);
  }
  return kalman_update(predicted.state, prior_information, linearization, information, gain_mask());
}

Belief LidarUpdate::trial(const Belief& predicted, const ErrorMatrix& prior_information,
                          std::span<const Eigen::Vector3f> points, const VoxelMap& map,
                          ScanDiagnostics& diagnostics) {
  matcher_.reset();
  Belief belief = predicted;
  NominalState matched_at = predicted.state;
  matcher_.match(matched_at, points, map);
  for (int i = 0; i < lidar_.max_iterations; ++i) {
    if (moved(belief.state, matched_at, lidar_.rematch_rotation, lidar_.rematch_position)) {
      matched_at = belief.state;
      matcher_.match(matched_at, points, map);
    }
    const ScanInformation scan = matcher_.linearize(belief.state);
    if (i == 0) {
      diagnostics.residual_sigma_prior =
          std::sqrt(residual_statistics(matcher_.residuals()).variance);
    }
    diagnostics.points_used = scan.used;
    if (scan.used < lidar_.min_matches) return predicted;
    const NominalState before = belief.state;
    matcher_.update_robust_scale();
    if (i == 0 && variant_.directional) assess_axes(scan, before, diagnostics);
    belief = correct(predicted, prior_information, before, scan, 1.0);
    ++diagnostics.iterations;
    if (!moved(belief.state, before, lidar_.convergence_rotation, lidar_.convergence_position)) {
      break;
    }
  }
  return belief;
}

void LidarUpdate::assess(const Belief& predicted, const ErrorMatrix& prior_information,
                         const NominalState& trial_state, ScanDiagnostics& diagnostics) {
  const ResidualStatistics statistics = residual_statistics(matcher_.residuals());
  const double prior_sigma = diagnostics.residual_sigma_prior;
  const ErrorVector y = boxminus(trial_state, predicted.state);  // eq. (5)
  diagnostics.residual_mean = statistics.mean;
  diagnostics.residual_sigma = std::sqrt(statistics.variance);
  diagnostics.O_lidar = effective_observability(statistics.variance, degeneracy_.sigma_0);
  diagnostics.O_lidar_prior =
      effective_observability(prior_sigma * prior_sigma, degeneracy_.sigma_0);
  diagnostics.C_IL_imu_legs = lidar_consistency(trial_state, predicted);
  const bool imu_alone = degeneracy_.prediction == ConsistencyPrediction::kImu &&
                         std::isfinite(diagnostics.C_IL_imu);
  diagnostics.C_IL = imu_alone ? diagnostics.C_IL_imu : diagnostics.C_IL_imu_legs;
  diagnostics.C_IL_full = consistency_full(y, prior_information);
  diagnostics.innovation_rotation = segment(y, ErrorState::kRotation);
  diagnostics.innovation_position = segment(y, ErrorState::kPosition);
  const double O_lidar =
      degeneracy_.prior_residuals ? diagnostics.O_lidar_prior : diagnostics.O_lidar;
  diagnostics.D = degeneracy_severity(O_lidar, diagnostics.C_IL, degeneracy_);  // eq. (7)
  severity_.update(diagnostics.D);                                              // eq. (12)
}

/// C_IL of the prediction by the IMU alone. The LiDAR-updated state of eq. (5) is what the scan
/// makes of that prediction, not of the filter's: the trial state is pulled towards the legs along
/// axes that the scan hardly constrains, and the difference would show up as inconsistency of the
/// LiDAR. The scan is linearized at the trial state, which both updates share when converged; with
/// the robust kernel its weights are those of the last iteration, one later than in the trial.
double LidarUpdate::leg_free_consistency(const Belief& leg_free, const NominalState& linearization,
                                         const ScanInformation& scan) const {
  const ErrorMatrix prior_information = inverse_spd(leg_free.covariance);
  const Belief updated = correct(leg_free, prior_information, linearization, scan, 1.0);
  return lidar_consistency(updated.state, leg_free);
}

void LidarUpdate::update_map_covariance(const VoxelMap& map, const Belief& predicted,
                                        const Belief& updated) {
  const auto position = [](const Belief& belief) {
    return Eigen::Matrix3d(block(belief.covariance, ErrorState::kPosition, ErrorState::kPosition));
  };
  map_covariance_ =
      map_covariance_after_scan(map_covariance_, position(predicted), position(updated),
                                matcher_.mapped_planes(updated.state, map));
}

Belief LidarUpdate::update(const Belief& predicted, std::span<const Eigen::Vector3f> points,
                           const VoxelMap& map, ScanDiagnostics& diagnostics,
                           const Belief* leg_free) {
  const ErrorMatrix prior_information = inverse_spd(predicted.covariance);
  Belief belief = trial(predicted, prior_information, points, map, diagnostics);
  const bool matched = diagnostics.points_used >= lidar_.min_matches;
  if (matched) {
    const ScanInformation scan = matcher_.linearize(belief.state);
    if (leg_free != nullptr) {
      diagnostics.C_IL_imu = leg_free_consistency(*leg_free, belief.state, scan);
    }
    diagnostics.points_used = scan.used;
    record_localizability(scan.matrix, diagnostics);
    assess(predicted, prior_information, belief.state, diagnostics);
    gamma_lidar_ = variant_.adaptive ? lidar_reliability(severity_.value(), degeneracy_) : 1.0;
    gamma_leg_ = variant_.adaptive ? leg_reliability(severity_.value(), degeneracy_) : 1.0;
    // The last linearization of the trial serves for the final update too.
    belief = correct(predicted, prior_information, belief.state, scan, gamma_lidar_);
    if (variant_.directional) update_map_covariance(map, predicted, belief);
  }
  diagnostics.D_smoothed = severity_.value();
  diagnostics.gamma_lidar = gamma_lidar_;
  diagnostics.gamma_leg = gamma_leg_;
  return belief;
}

}  // namespace aims
