// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/aims/lidar_update.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "estimator/aims/leg_free_prediction.hpp"

namespace aims {
namespace {

/// One of this many points serves the first guess.
constexpr std::size_t kGuessStride = 5;

/// Larger steps of an iteration search the planes again, smaller ones end it.
constexpr double kRematchRotation = 2e-3;    ///< [rad]
constexpr double kRematchPosition = 1e-2;    ///< [m]
constexpr double kConvergedRotation = 1e-4;  ///< [rad]
constexpr double kConvergedPosition = 1e-3;  ///< [m]

/// Smallest eigenvalue and condition number of the translation information with unknown rotation
/// (its Schur complement).
void record_localizability(const HalvesInformation& scan, ScanDiagnostics& diagnostics) {
  diagnostics.weak_weight = weakest_real_fraction(scan);
  diagnostics.weak_tilt = weakest_real_tilt(scan);
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(position_information(scan.within),
                                                              Eigen::EigenvaluesOnly);
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

LidarUpdate::LidarUpdate(const EskfConfig& config)
    : max_iterations_(config.lidar.max_iterations),
      degeneracy_(config.degeneracy),
      cross_validation_(config.cross_validation),
      map_covariance_enabled_(config.map_covariance.enabled),
      matcher_(config.lidar.correlated_points, config.robust_kernel),
      severity_(config.degeneracy.alpha) {}

/// The scan as it is fused: eq. (9), R_lidar' = R_lidar / gamma_lidar, multiplies its information
/// by gamma_lidar; with `cross_validation` only its real part counts.
Linearization LidarUpdate::fused(const MatchInformation& scan, double gamma,
                                 const NominalState& state) const {
  const PoseInformation pose = cross_validation_.enabled
                                   ? fraction_.applied_to(scan.halves)
                                   : PoseInformation{scan.halves.within, scan.halves.within_vector};
  Linearization linearization{scan_measurement(gamma * pose.matrix, gamma * pose.vector,
                                               calibration_, state.rotation.toRotationMatrix()),
                              odometry_mask()};
  linearization.mask.velocity = linearization.mask.position;
  return linearization;
}

GainMask LidarUpdate::odometry_mask() const {
  if (!considers_legs()) return {};
  return {.legs = false, .position = fraction_.constrained()};
}

/// One step with a few of the points: where all of them meet nearly the planes of the result, so
/// that they are searched once.
NominalState LidarUpdate::first_guess(const Belief& predicted,
                                      std::span<const Eigen::Vector3f> points, const VoxelMap& map,
                                      ScanDiagnostics& diagnostics) {
  const NominalState& at = predicted.state;
  matcher_.match(at, points, map, kGuessStride);
  const MatchInformation scan = matcher_.linearize(at);
  diagnostics.residual_sigma_prior = std::sqrt(residual_statistics(matcher_.residuals()).variance);
  if (scan.used < kMinMatches) return at;
  const Linearization guess = fused(scan, 1.0, at);
  return fuse(predicted, at, guess.measurement, guess.mask).state;
}

IteratedUpdate LidarUpdate::trial(const Belief& predicted, std::span<const Eigen::Vector3f> points,
                                  const VoxelMap& map, ScanDiagnostics& diagnostics) {
  matcher_.reset(calibration_.lever);
  const NominalState start = first_guess(predicted, points, map, diagnostics);
  matcher_.start_robust_weights();
  NominalState matched_at = start;
  matcher_.match(matched_at, points, map);
  bool first = true;
  const auto linearize = [&](const NominalState& at) -> std::optional<Linearization> {
    if (moved(at, matched_at, kRematchRotation, kRematchPosition)) {
      matched_at = at;
      matcher_.match(matched_at, points, map);
    }
    const MatchInformation scan = matcher_.linearize(at);
    diagnostics.points_used = scan.used;
    if (scan.used < kMinMatches) return std::nullopt;
    if (first && cross_validation_.enabled) fraction_.add(scan.halves, at.position);
    first = false;
    return fused(scan, 1.0, at);
  };
  const auto converged = [&](const NominalState& before, const NominalState& after) {
    return !moved(after, before, kConvergedRotation, kConvergedPosition);
  };
  return iterated_update(predicted, start, max_iterations_, linearize, converged);
}

void LidarUpdate::assess(const Belief& predicted, const NominalState& trial_state,
                         ScanDiagnostics& diagnostics) {
  const ResidualStatistics statistics = residual_statistics(matcher_.residuals());
  const ErrorVector y = boxminus(trial_state, predicted.state);  // eq. (5)
  diagnostics.residual_mean = statistics.mean;
  diagnostics.residual_sigma = std::sqrt(statistics.variance);
  diagnostics.C_IL_imu_legs = lidar_consistency(trial_state, predicted);
  diagnostics.C_IL_full = consistency_full(y, predicted.covariance);
  diagnostics.innovation_rotation = segment(y, ErrorState::kRotation);
  diagnostics.innovation_position = segment(y, ErrorState::kPosition);
  if (degeneracy_.enabled) assess_degeneracy(statistics.variance, diagnostics);
}

void LidarUpdate::assess_degeneracy(double residual_variance, ScanDiagnostics& diagnostics) {
  const double prior_sigma = diagnostics.residual_sigma_prior;
  diagnostics.O_lidar = effective_observability(residual_variance, degeneracy_.sigma_0);
  diagnostics.O_lidar_prior =
      effective_observability(prior_sigma * prior_sigma, degeneracy_.sigma_0);
  const double O_lidar =
      degeneracy_.prior_residuals ? diagnostics.O_lidar_prior : diagnostics.O_lidar;
  const bool imu_alone =
      degeneracy_.prediction == ConsistencyPrediction::kImu && std::isfinite(diagnostics.C_IL_imu);
  diagnostics.C_IL = imu_alone ? diagnostics.C_IL_imu : diagnostics.C_IL_imu_legs;
  diagnostics.D = degeneracy_severity(O_lidar, diagnostics.C_IL, degeneracy_);  // eq. (7)
  severity_.update(diagnostics.D);                                              // eq. (12)
  gamma_lidar_ = lidar_reliability(severity_.value(), degeneracy_);
  gamma_leg_ = leg_reliability(severity_.value(), degeneracy_);
}

/// C_IL of the prediction by the IMU alone. The LiDAR-updated state of eq. (5) is what the scan
/// makes of that prediction, not of the filter's: the trial state is pulled towards the legs along
/// axes that the scan hardly constrains, and the difference would show up as inconsistency of the
/// LiDAR. The scan is linearized at the trial state, which both updates share when converged; with
/// the robust kernel its weights are those of the last iteration, one later than in the trial.
double LidarUpdate::leg_free_consistency(const Belief& leg_free, const NominalState& linearization,
                                         const MatchInformation& scan) const {
  const Linearization measured = fused(scan, 1.0, linearization);
  const Belief updated = fuse(leg_free, linearization, measured.measurement, measured.mask);
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
                           const VoxelMap& map, const CalibrationModel& calibration,
                           ScanDiagnostics& diagnostics, const Belief* leg_free) {
  calibration_ = calibration;
  const auto trial = this->trial(predicted, points, map, diagnostics);
  const NominalState& at = trial.belief.state;
  MatchInformation scan;
  if (!trial.refused) {
    scan = matcher_.linearize(at);
    diagnostics.points_used = scan.used;
  }
  // The residual gate may leave fewer matches at the result of the trial than before it.
  Belief belief = predicted;
  if (scan.used >= kMinMatches) {
    diagnostics.iterations = trial.iterations;
    diagnostics.converged = trial.converged;
    record_localizability(scan.halves, diagnostics);
    if (leg_free != nullptr) diagnostics.C_IL_imu = leg_free_consistency(*leg_free, at, scan);
    assess(predicted, at, diagnostics);
    const Linearization weighed = fused(scan, gamma_lidar_, at);
    belief = fuse(predicted, at, weighed.measurement, weighed.mask);
    matcher_.learn_noise();
    if (map_covariance_enabled_) update_map_covariance(map, predicted, belief);
  }
  if (degeneracy_.enabled) diagnostics.D_smoothed = severity_.value();
  diagnostics.gamma_lidar = gamma_lidar_;
  diagnostics.gamma_leg = gamma_leg_;
  return belief;
}

}  // namespace aims
