// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <span>

#include "estimator/aims/config.hpp"
#include "estimator/aims/scan_diagnostics.hpp"
#include "estimator/constrained/scan_rule.hpp"
#include "estimator/degeneracy/cross_validation.hpp"
#include "estimator/degeneracy/degeneracy.hpp"
#include "estimator/filter/kalman_update.hpp"
#include "estimator/lidar/scan_matcher.hpp"
#include "estimator/lidar/voxel_map.hpp"

namespace aims {

/// The paper's degeneracy index of each scan and the weights that it gives LiDAR and legs, eqs. (4)
/// to (12). Where `config` does not enable it, both weights stay 1.
class AdaptiveWeights {
 public:
  explicit AdaptiveWeights(const DegeneracyConfig& config);

  /// Assesses a scan by the variance of its residuals [m^2] and by what `diagnostics` has of C_IL
  /// and of the residuals before the update; fills in O_lidar, C_IL and D_k.
  void assess(double residual_variance, ScanDiagnostics& diagnostics);

  /// Fills in the smoothed index and the weights after the last scan that was assessed.
  void record(ScanDiagnostics& diagnostics) const;

  double gamma_lidar() const { return gamma_lidar_; }  ///< eq. (8); R_lidar' = R_lidar / gamma
  double gamma_leg() const { return gamma_leg_; }      ///< eq. (10); R_leg' = R_leg / gamma

 private:
  DegeneracyConfig config_;
  SeverityFilter severity_;
  double gamma_lidar_ = 1.0;
  double gamma_leg_ = 1.0;
};

/// Planes needed for an update.
inline constexpr int kMinMatches = 30;

/// What of the information of a scan is fused.
enum class ScanPart {
  kAll,   ///< that from the noise of the map included
  kReal,  ///< that on which both halves of the map agree
};

/// The LiDAR correction in three steps: an iterated trial update with the nominal noise, the
/// degeneracy index from its residuals and innovation, and the final update with the noise scaled
/// by the index. With `cross_validation`, information that only one half of the map supports, which
/// is noise of its planes, can be left out.
class LidarUpdate {
 public:
  /// `rule`: the update of the filter with a scan in place of the plain one; null: the plain one.
  explicit LidarUpdate(const EskfConfig& config, std::unique_ptr<const ScanRule> rule = nullptr);

  /// The belief after fusing `points` (body axes at the time of the belief) with `map`. Fills the
  /// index, weights and statistics of `diagnostics`. With too few planes at any linearization, the
  /// last included, the belief and the index are unchanged and `iterations` is 0. `leg_free` is the
  /// prediction of the IMU alone, for C_IL; null: not known, C_IL then takes `predicted`.
  /// `calibration` is the scan's dependence on mount and delay. Without `cross_validation` a scan
  /// has no part but kAll.
  Belief update(const Belief& predicted, std::span<const Eigen::Vector3f> points,
                const VoxelMap& map, const CalibrationModel& calibration, ScanPart part,
                ScanDiagnostics& diagnostics, const Belief* leg_free = nullptr);

  /// The turn about the vertical, at most `reach` [rad] to either side of `predicted`, after which
  /// the most points fit the map; nothing where no heading has kMinMatches planes.
  std::optional<double> turn_onto_map(const Belief& predicted,
                                      std::span<const Eigen::Vector3f> points, const VoxelMap& map,
                                      const CalibrationModel& calibration, double reach);

  /// A second belief for the same time, `predicted`, after fusing the cross-validated part of the
  /// scan that update() fused last (at least one iteration, same map). Along directions that the
  /// scan does not constrain the two beliefs may be far apart.
  Belief update_with_real_part(const Belief& predicted, const VoxelMap& map);

  /// From the next scan on: whether scans leave leg scale and bias as they are.
  void hold_legs(bool held) { holds_legs_ = held; }

  /// gamma_leg after the last scan, eq. (10); 1 before the first.
  double gamma_leg() const { return weights_.gamma_leg(); }

  /// Whether leg scale and bias are consider states: along a direction that scans do not constrain
  /// only the legs measure the velocity, so their errors are unobservable.
  bool considers_legs() const {
    return cross_validation_.enabled && (measures_legs_ || fraction_.leaves_direction_free());
  }

  /// Whether cross-validation has shown that the last scan leaves no direction free.
  bool constrains_all_directions() const { return cross_validation_.enabled && !considers_legs(); }

  /// Whether cross-validation has shown that the last scans constrain the way ahead of `state`,
  /// whatever of them the real part keeps.
  bool constrains_the_way(const NominalState& state) const;

  /// The belief after fusing a velocity; `mask` applies where scans constrain every direction.
  /// Along an unconstrained direction the gain is conditioned on a known leg scale
  /// (Schmidt-Kalman): position and velocity share the error of the leg scale over the whole route,
  /// and the full gain would turn a model error of a percent into a step of the position with every
  /// sample.
  Belief fuse_velocity(const Belief& belief, const LinearMeasurement& velocity,
                       const GainMask& mask = {}) const;

  /// Covariance of the map at the robot, odometry axes [m^2]; see map_covariance_after_scan().
  const Eigen::Matrix3d& map_covariance() const { return map_covariance_; }

 private:
  std::optional<double> shared_tilt() const;
  GainMask scan_mask(const NominalState& state) const;
  Linearization to_fuse(ScanPart part, double gamma, const NominalState& state) const;
  Belief fused_with(const Belief& prior, const NominalState& at, const Linearization& scan);
  NominalState settled(const Belief& predicted, std::span<const Eigen::Vector3f> points,
                       const VoxelMap& map);
  NominalState first_guess(const Belief& predicted, std::span<const Eigen::Vector3f> points,
                           const VoxelMap& map, ScanDiagnostics& diagnostics);
  NominalState match_along_drift(const Belief& predicted, const NominalState& guess,
                                 std::span<const Eigen::Vector3f> points, const VoxelMap& map,
                                 ScanDiagnostics& diagnostics);
  IteratedUpdate trial(const Belief& predicted, std::span<const Eigen::Vector3f> points,
                       const VoxelMap& map, ScanDiagnostics& diagnostics);
  void assess(const Belief& predicted, const NominalState& trial_state,
              ScanDiagnostics& diagnostics);
  double leg_free_consistency(const Belief& leg_free, const NominalState& linearization) const;
  void update_map_covariance(const VoxelMap& map, const NominalState& matching,
                             const Belief& predicted, const Belief& updated);

  std::unique_ptr<const ScanRule> rule_;  ///< null: the plain update
  ScanVerdict verdict_;                   ///< of the rule, in the last step
  int max_iterations_;                    ///< of the trial update
  int scans_ = 0;                         ///< so far
  CalibrationModel calibration_;          ///< of the present scan
  ScanPart part_;                         ///< of it that update() fuses
  MatchInformation scan_;                 ///< the present scan at the last linearization
  NominalState predicted_;                ///< what update() matched the scan from
  NominalState matched_at_;               ///< where its matches were linearized last
  CrossValidationConfig cross_validation_;
  bool holds_legs_ = false;
  bool measures_legs_;  ///< the real part holds nothing along the way
  CrossValidatedInformation fraction_;
  bool map_covariance_enabled_;
  ScanMatcher matcher_;
  AdaptiveWeights weights_;
  Eigen::Matrix3d map_covariance_ = Eigen::Matrix3d::Zero();
};

}  // namespace aims
