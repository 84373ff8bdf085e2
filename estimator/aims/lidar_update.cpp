// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/aims/lidar_update.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <utility>

#include "estimator/aims/leg_free_prediction.hpp"
#include "estimator/degeneracy/degeneracy.hpp"
#include "estimator/filter/outage.hpp"
#include "estimator/filter/pose_information.hpp"
#include "estimator/lidar/drift_search.hpp"

namespace aims {

AdaptiveWeights::AdaptiveWeights(const DegeneracyConfig& config)
    : config_(config), severity_(config.alpha) {}

void AdaptiveWeights::assess(double residual_variance, ScanDiagnostics& diagnostics) {
  if (!config_.enabled) return;
  const double prior_sigma = diagnostics.residual_sigma_prior;
  diagnostics.O_lidar = effective_observability(residual_variance, config_.sigma_0);
  diagnostics.O_lidar_prior = effective_observability(prior_sigma * prior_sigma, config_.sigma_0);
  const double O_lidar = config_.prior_residuals ? diagnostics.O_lidar_prior : diagnostics.O_lidar;
  const bool imu_alone =
      config_.prediction == ConsistencyPrediction::kImu && std::isfinite(diagnostics.C_IL_imu);
  diagnostics.C_IL = imu_alone ? diagnostics.C_IL_imu : diagnostics.C_IL_imu_legs;
  diagnostics.D = degeneracy_severity(O_lidar, diagnostics.C_IL, config_);  // eq. (7)
  severity_.update(diagnostics.D);                                          // eq. (12)
  gamma_lidar_ = lidar_reliability(severity_.value(), config_);
  gamma_leg_ = leg_reliability(severity_.value(), config_);
}

void AdaptiveWeights::record(ScanDiagnostics& diagnostics) const {
  if (config_.enabled) diagnostics.D_smoothed = severity_.value();
  diagnostics.gamma_lidar = gamma_lidar_;
  diagnostics.gamma_leg = gamma_leg_;
}

namespace {

/// One of this many points serves the first guess.
constexpr std::size_t kGuessStride = 5;

/// Larger steps of an iteration search the planes again and never end it, smaller ones end it.
constexpr double kRematchRotation = 2e-3;    ///< [rad]
constexpr double kRematchPosition = 1e-2;    ///< [m]
constexpr double kConvergedRotation = 1e-4;  ///< [rad]
constexpr double kConvergedPosition = 1e-3;  ///< [m]

/// Where a scan is searched in the map, in deviations of the prediction along its least certain
/// axis, and at most [m]: the search takes time in proportion.
constexpr double kSearchedDeviations = 3.0;
constexpr double kMaxSearched = 3.0;
/// One of so many scans is searched: half a second of a surface that is mapped a second time has no
/// planes in both halves of the map yet.
constexpr int kSearchEvery = 5;
/// Smaller offsets are left to the residuals, which reach as far.
constexpr double kMinOffset = 0.5 * kMaxResidual;

/// Between the headings that are tried: from half of it the matching converges [rad].
constexpr double kHeadingStep = 0.2;
constexpr int kHeadingIterations = 6;
/// A heading farther away must fit so many times the points.
constexpr double kClearlyMore = 1.1;

/// Tilt that both halves share of a map whose scans were placed by all information, the noise of
/// the map included (docs/decisions.md) [rad].
constexpr double kSharedTilt = 0.009;

/// An axis of the position [odometry axes] and the deviation along it [m].
struct Uncertainty {
  Eigen::Vector3d axis;
  double sigma;
};

/// The largest of a position's `covariance` [m^2].
Uncertainty largest_uncertainty(const Eigen::Matrix3d& covariance) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(covariance);
  return {solver.eigenvectors().col(2), std::sqrt(solver.eigenvalues()(2))};
}

/// Smallest eigenvalue and condition number of the translation information with unknown rotation
/// (its Schur complement), and the smallest eigenvalue of `real`, what of the scan counts as real.
void record_localizability(const HalvesInformation& scan, const Matrix6& real,
                           ScanDiagnostics& diagnostics) {
  diagnostics.weak_weight = weakest_real_fraction(scan);
  diagnostics.weak_tilt = weakest_real_tilt(scan);
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(position_information(scan.within),
                                                              Eigen::EigenvaluesOnly);
  diagnostics.smallest_eigenvalue = std::max(solver.eigenvalues()(0), 0.0);
  diagnostics.condition_number =
      solver.eigenvalues()(2) / std::max(diagnostics.smallest_eigenvalue, 1e-9);
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> of_real(position_information(real),
                                                               Eigen::EigenvaluesOnly);
  diagnostics.weak_information = std::max(of_real.eigenvalues()(0), 0.0);
}

/// The information that a scan states.
Matrix6 stated_by(const PoseInformation& scan) { return scan.stated.value_or(scan.matrix); }

/// Whether the pose changed by more than `rotation` [rad] or `position` [m].
bool moved(const Pose& pose, const Pose& since, double rotation, double position) {
  return pose.rotation.angularDistance(since.rotation) > rotation ||
         (pose.translation - since.translation).norm() > position;
}

/// A step so large that the planes must be searched again is kLarge.
Step step_between(const Pose& before, const Pose& after) {
  if (moved(after, before, kRematchRotation, kRematchPosition)) return Step::kLarge;
  return moved(after, before, kConvergedRotation, kConvergedPosition) ? Step::kSmall
                                                                      : Step::kConverged;
}

/// Along the heading, level, odometry axes.
Eigen::Vector3d along_the_way(const NominalState& state) {
  Eigen::Vector3d ahead = state.rotation * Eigen::Vector3d::UnitX();
  ahead.z() = 0.0;
  return ahead.normalized();
}

/// Projection of the position onto what lies across the heading, odometry axes.
Eigen::Matrix3d across_the_way(const NominalState& state) {
  const Eigen::Vector3d ahead = along_the_way(state);
  return Eigen::Matrix3d::Identity() - ahead * ahead.transpose();
}

}  // namespace

LidarUpdate::LidarUpdate(const EskfConfig& config, std::unique_ptr<const ScanRule> rule)
    : rule_(std::move(rule)),
      max_iterations_(config.lidar.max_iterations),
      cross_validation_(config.cross_validation),
      measures_legs_(measures_legs(config)),
      map_covariance_enabled_(config.map_covariance.enabled),
      matcher_(config.lidar.correlated_points, config.robust_kernel),
      weights_(config.degeneracy) {
  cross_validation_.enabled = cross_validation_.enabled && config.lidar.enabled;
}

/// Part of the present scan to be fused: eq. (9), R_lidar' = R_lidar / gamma_lidar, multiplies
/// its information by gamma_lidar.
Linearization LidarUpdate::to_fuse(ScanPart part, double gamma, const NominalState& state) const {
  const bool real = part == ScanPart::kReal && cross_validation_.enabled;
  PoseInformation pose = real ? fraction_.applied_to(scan_.halves)
                              : PoseInformation{scan_.halves.within, scan_.halves.within_vector};
  if (real && measures_legs_) {
    Matrix6 kept = Matrix6::Identity();
    kept.bottomRightCorner<3, 3>() = across_the_way(state);
    if (pose.stated) pose.stated = kept * *pose.stated * kept;
    pose.matrix = kept * pose.matrix * kept;
    pose.vector = kept * pose.vector;
  }
  PoseMeasurement measurement = scan_measurement(gamma * pose.matrix, gamma * pose.vector,
                                                 calibration_, state.rotation.toRotationMatrix());
  if (pose.stated) measurement.stated = gamma * *pose.stated;
  return {measurement, real ? scan_mask(state) : GainMask{.legs = !holds_legs_}};
}

GainMask LidarUpdate::scan_mask(const NominalState& state) const {
  if (!considers_legs()) return {.legs = !holds_legs_};
  const bool free = fraction_.leaves_direction_free();
  Eigen::Matrix3d translation = free ? fraction_.constrained() : Eigen::Matrix3d::Identity();
  if (measures_legs_) {
    translation = across_the_way(state) * translation * across_the_way(state);
  }
  return {.legs = false, .translation = translation};
}

std::optional<double> LidarUpdate::shared_tilt() const {
  return part_ == ScanPart::kAll ? std::optional(kSharedTilt) : std::nullopt;
}

/// A free axis within 45 degrees of the way leaves it free.
bool LidarUpdate::constrains_the_way(const NominalState& state) const {
  if (!cross_validation_.enabled) return false;
  const Eigen::Vector3d ahead = along_the_way(state);
  return ahead.dot(fraction_.constrained() * ahead) > 0.5;
}

Belief LidarUpdate::fuse_velocity(const Belief& belief, const LinearMeasurement& velocity,
                                  const GainMask& mask) const {
  return considers_legs() ? fuse_given_legs(belief, velocity, mask) : fuse(belief, velocity, mask);
}

/// One step from `at`, where the scan is linearized.
Belief LidarUpdate::fused_with(const Belief& prior, const NominalState& at,
                               const Linearization& scan) {
  if (!rule_) return fuse(prior, at, scan.measurement, scan.mask);
  const auto matches = matcher_.correspondences(scan_pose(at, calibration_));
  RuledUpdate update = rule_->fuse(prior, at, scan, matches);
  verdict_ = update.verdict;
  return update.belief;
}

/// Where the scan settles in the map from `predicted`, with every fifth point; `scan_` counts the
/// matches.
NominalState LidarUpdate::settled(const Belief& predicted, std::span<const Eigen::Vector3f> points,
                                  const VoxelMap& map) {
  NominalState at = predicted.state;
  for (int i = 0;; ++i) {
    const Pose pose = scan_pose(at, calibration_);
    matcher_.match(pose, points, map, kGuessStride);
    scan_ = matcher_.linearize(pose);
    if (scan_.used < kMinMatches || i == kHeadingIterations) return at;
    const Linearization scan = to_fuse(ScanPart::kAll, 1.0, at);
    at = fuse(predicted, at, scan.measurement, scan.mask).state;
  }
}

std::optional<double> LidarUpdate::turn_onto_map(const Belief& predicted,
                                                 std::span<const Eigen::Vector3f> points,
                                                 const VoxelMap& map,
                                                 const CalibrationModel& calibration,
                                                 double reach) {
  calibration_ = calibration;
  matcher_.reset(calibration_.lever);
  const double heading = yaw_of(predicted.state.rotation);
  std::optional<double> best;
  double most = 0.0;
  const int steps = static_cast<int>(std::ceil(reach / kHeadingStep));
  for (int i = 0; i <= 2 * steps; ++i) {  // outwards: 0, 1, -1, 2, -2, ...
    const double turn = kHeadingStep * ((i + 1) / 2) * (i % 2 == 0 ? -1.0 : 1.0);
    const NominalState at =
        settled({turned(predicted.state, turn), predicted.covariance}, points, map);
    if (scan_.used < kMinMatches) continue;
    const int fit = matcher_.agreement(scan_pose(at, calibration_), Eigen::Vector3d::UnitZ()).all;
    if (fit < kClearlyMore * most) continue;
    most = fit;
    best = wrap_angle(yaw_of(at.rotation) - heading);
  }
  return best;
}

/// One step with every fifth point. Its result is so close to the final one that the planes of all
/// points are searched only once. A rule judges by how many points there are, so it has none.
NominalState LidarUpdate::first_guess(const Belief& predicted,
                                      std::span<const Eigen::Vector3f> points, const VoxelMap& map,
                                      ScanDiagnostics& diagnostics) {
  const NominalState& at = predicted.state;
  const Pose pose = scan_pose(at, calibration_);
  matcher_.match(pose, points, map, kGuessStride);
  scan_ = matcher_.linearize(pose);
  diagnostics.residual_sigma_prior = std::sqrt(residual_statistics(matcher_.residuals()).variance);
  if (scan_.used < kMinMatches || rule_) return at;
  const Linearization guess = to_fuse(part_, 1.0, at);
  return fuse(predicted, at, guess.measurement, guess.mask).state;
}

/// Matches the points at `guess`, or at an offset along the least certain axis at which more of
/// them lie on planes of the map. After a drift larger than the matching distance, a robot that
/// comes back would otherwise find no match with its own map and map the place twice.
NominalState LidarUpdate::match_along_drift(const Belief& predicted, const NominalState& guess,
                                            std::span<const Eigen::Vector3f> points,
                                            const VoxelMap& map, ScanDiagnostics& diagnostics) {
  const Pose here = scan_pose(guess, calibration_);
  matcher_.match(here, points, map);
  if (++scans_ % kSearchEvery != 0) return guess;
  const Uncertainty drift = largest_uncertainty(
      block(predicted.covariance, ErrorState::kPosition, ErrorState::kPosition) + map_covariance_);
  const double reach = std::min(kSearchedDeviations * drift.sigma, kMaxSearched);
  if (reach <= kMaxResidual) return guess;
  const auto offset = offset_by_consensus(matcher_.unmatched(), here, drift.axis, reach, map);
  if (!offset || std::abs(*offset) < kMinOffset) return guess;
  const Agreement usual = matcher_.agreement(here, drift.axis);
  NominalState moved = guess;
  moved.position += *offset * drift.axis;
  const Pose there = scan_pose(moved, calibration_);
  matcher_.match(there, points, map);
  const Agreement found = matcher_.agreement(there, drift.axis);
  if (found.facing >= usual.facing + kMinConsensus && found.all > usual.all) {
    diagnostics.relocated = true;
    return moved;
  }
  matcher_.match(here, points, map);
  return guess;
}

IteratedUpdate LidarUpdate::trial(const Belief& predicted, std::span<const Eigen::Vector3f> points,
                                  const VoxelMap& map, ScanDiagnostics& diagnostics) {
  matcher_.reset(calibration_.lever);
  const NominalState guess = first_guess(predicted, points, map, diagnostics);
  matcher_.start_robust_weights();
  const NominalState start = match_along_drift(predicted, guess, points, map, diagnostics);
  Pose matched_at = scan_pose(start, calibration_);
  bool first = true;
  const auto linearize = [&](const NominalState& at) -> std::optional<Linearization> {
    const Pose pose = scan_pose(at, calibration_);
    if (moved(pose, matched_at, kRematchRotation, kRematchPosition)) {
      matched_at = pose;
      matcher_.match(matched_at, points, map);
    }
    scan_ = matcher_.linearize(pose);
    diagnostics.points_used = scan_.used;
    if (scan_.used < kMinMatches) return std::nullopt;
    if (first && cross_validation_.enabled) fraction_.add(scan_.halves, at.position, shared_tilt());
    first = false;
    return to_fuse(part_, 1.0, at);
  };
  const auto step_of = [&](const NominalState& before, const NominalState& after) {
    return step_between(scan_pose(before, calibration_), scan_pose(after, calibration_));
  };
  const auto fuse_at = [&](const Belief& prior, const NominalState& at, const Linearization& scan) {
    return fused_with(prior, at, scan);
  };
  return iterated_update(predicted, start, max_iterations_, linearize, step_of, fuse_at);
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
  weights_.assess(statistics.variance, diagnostics);
}

/// C_IL of the prediction by the IMU alone. The LiDAR-updated state of eq. (5) is what the scan
/// makes of that prediction, not of the filter's: the trial state is pulled towards the legs along
/// axes that the scan hardly constrains, and the difference would show up as inconsistency of the
/// LiDAR. The scan is linearized at the trial state, which both updates share when converged; with
/// the robust kernel its weights are those of the last iteration, one later than in the trial.
double LidarUpdate::leg_free_consistency(const Belief& leg_free,
                                         const NominalState& linearization) const {
  const Linearization measured = to_fuse(part_, 1.0, linearization);
  const Belief updated = fuse(leg_free, linearization, measured.measurement, measured.mask);
  return lidar_consistency(updated.state, leg_free);
}

/// `matching`: where the scan lies in the map.
void LidarUpdate::update_map_covariance(const VoxelMap& map, const NominalState& matching,
                                        const Belief& predicted, const Belief& updated) {
  if (!map_covariance_enabled_) return;
  const auto position = [](const Belief& belief) {
    const ErrorMatrix P = stated_covariance(belief);
    return Eigen::Matrix3d(block(P, ErrorState::kPosition, ErrorState::kPosition));
  };
  map_covariance_ =
      map_covariance_after_scan(map_covariance_, position(predicted), position(updated),
                                matcher_.mapped_planes(scan_pose(matching, calibration_), map));
}

Belief LidarUpdate::update(const Belief& predicted, std::span<const Eigen::Vector3f> points,
                           const VoxelMap& map, const CalibrationModel& calibration, ScanPart part,
                           ScanDiagnostics& diagnostics, const Belief* leg_free) {
  calibration_ = calibration;
  part_ = part;
  predicted_ = predicted.state;
  const auto trial = this->trial(predicted, points, map, diagnostics);
  const NominalState& at = trial.belief.state;
  scan_ = trial.refused ? MatchInformation() : matcher_.linearize(scan_pose(at, calibration_));
  if (!trial.refused) diagnostics.points_used = scan_.used;
  // The residual gate may leave fewer matches at the result of the trial than before it.
  Belief belief = predicted;
  if (scan_.used >= kMinMatches) {
    matched_at_ = at;
    diagnostics.iterations = trial.iterations;
    diagnostics.converged = trial.converged;
    record_localizability(scan_.halves,
                          cross_validation_.enabled ? stated_by(fraction_.applied_to(scan_.halves))
                                                    : scan_.halves.within,
                          diagnostics);
    if (leg_free != nullptr) diagnostics.C_IL_imu = leg_free_consistency(*leg_free, at);
    assess(predicted, at, diagnostics);
    const Linearization weighed = to_fuse(part_, weights_.gamma_lidar(), at);
    belief = fused_with(predicted, at, weighed);
    diagnostics.verdict = verdict_;
    matcher_.learn_noise();
    if (part_ == ScanPart::kReal || !cross_validation_.enabled) {
      update_map_covariance(map, belief.state, predicted, belief);
    }
  }
  weights_.record(diagnostics);
  return belief;
}

/// Linearized where the scan was matched, but along free directions at the predicted position: it
/// may be far from the map there, and the scan has no information about that.
Belief LidarUpdate::update_with_real_part(const Belief& predicted, const VoxelMap& map) {
  NominalState at = predicted.state;
  at.rotation = matched_at_.rotation;
  at.mount = matched_at_.mount;
  at.delay = matched_at_.delay;
  const Eigen::Vector3d apart = predicted.state.position - predicted_.position;
  at.position = matched_at_.position + apart - scan_mask(predicted.state).translation * apart;
  const Linearization real = to_fuse(ScanPart::kReal, weights_.gamma_lidar(), at);
  const Belief belief = fuse(predicted, at, real.measurement, real.mask);
  update_map_covariance(map, matched_at_, predicted, belief);
  return belief;
}

}  // namespace aims
