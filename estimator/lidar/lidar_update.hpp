// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "estimator/aims/config.hpp"
#include "estimator/degeneracy/axis_weights.hpp"
#include "estimator/degeneracy/degeneracy.hpp"
#include "estimator/estimator.hpp"
#include "estimator/filter/kalman_update.hpp"
#include "estimator/lidar/map_anchor.hpp"
#include "estimator/lidar/plane_model.hpp"
#include "estimator/lidar/voxel_map.hpp"

namespace aims {

/// The LiDAR correction: an iterated trial update with the nominal noise, the degeneracy index that
/// its residuals and innovation give, and the final update with the noise that the index asks for.
/// The directional member weighs the information along the axes of the pose instead.
class LidarUpdate {
 public:
  /// The parts of `config.directional` are those of the member (`config_of`).
  LidarUpdate(const EstimatorConfig& config, const FamilyMember& member);

  /// The belief after fusing `points` (body axes at the belief's instant) against `map`. Fills the
  /// index, weights and statistics of `diagnostics`. With too few planes the belief is returned as
  /// it came, and the index stays where it was.
  Belief update(const Belief& predicted, std::span<const Eigen::Vector3f> points,
                const VoxelMap& map, ScanDiagnostics& diagnostics);

  /// gamma_leg after the last scan, eq. (10); 1 before the first.
  double gamma_leg() const { return gamma_leg_; }

  /// Whether the states of the legs are to be held: while the weakest axis is not trusted.
  bool holds_legs() const;

  /// Covariance of the map that the position rests on, odometry axes [m^2]; anchor_after_scan.
  const Eigen::Matrix3d& map_anchor() const { return map_anchor_; }

 private:
  static constexpr double kNotRobust = std::numeric_limits<double>::infinity();

  /// A point with its plane.
  struct Match {
    Eigen::Vector3d p_body;
    Plane plane;
  };

  /// The rows of all accepted matches at one pose.
  struct Linearization {
    Matrix6 matrix = Matrix6::Zero();  ///< H^T R^-1 H at nominal noise
    Vector6 vector = Vector6::Zero();  ///< H^T R^-1 r at nominal noise
    Matrix6 chance = Matrix6::Zero();  ///< of the matrix, by the errors of the normals
    int used = 0;
  };

  void associate(const NominalState& state, std::span<const Eigen::Vector3f> points,
                 const VoxelMap& map);
  Linearization linearize(const NominalState& state);
  Information weighed(const Linearization& rows, double gamma, const NominalState& state) const;
  /// What a scan may correct: nothing along axes that it does not see, whatever the covariance
  /// says of their ties with those that it sees.
  ErrorMatrix scan_mask() const;
  Belief correct(const Belief& predicted, const ErrorMatrix& prior_information,
                 const NominalState& linearization, const Linearization& rows, double gamma) const;
  void set_robust_scale();
  void assess_axes(const Linearization& rows, const NominalState& state,
                   ScanDiagnostics& diagnostics);
  Belief trial(const Belief& predicted, const ErrorMatrix& prior_information,
               std::span<const Eigen::Vector3f> points, const VoxelMap& map,
               ScanDiagnostics& diagnostics);
  void assess(const Belief& predicted, const ErrorMatrix& prior_information,
              const NominalState& trial_state, ScanDiagnostics& diagnostics);
  void rest_on(const VoxelMap& map, const Belief& predicted, const Belief& updated);
  bool moved(const NominalState& state, const NominalState& since, double rotation,
             double position) const;

  LidarUpdateConfig lidar_;
  DegeneracyConfig degeneracy_;
  DirectionalConfig directional_;
  FamilyMember member_;
  AxisWeigher axes_;
  SeverityFilter severity_;
  double gamma_lidar_ = 1.0;
  double gamma_leg_ = 1.0;
  Eigen::Matrix3d map_anchor_ = Eigen::Matrix3d::Zero();
  std::optional<Eigen::Vector3d> last_position_;  ///< at the last scan that was judged
  std::vector<Match> matches_;
  /// Residual at which the weight of a point is a half [m].
  double robust_scale_ = kNotRobust;
  std::vector<double> residuals_;
  std::vector<double> magnitudes_;
  std::vector<AnchoredPlane> anchored_;
};

}  // namespace aims
