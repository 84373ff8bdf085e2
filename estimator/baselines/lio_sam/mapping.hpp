// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <optional>
#include <vector>

#include "core/config.hpp"
#include "core/time.hpp"
#include "estimator/baselines/features/feature_map.hpp"
#include "estimator/baselines/features/feature_solver.hpp"
#include "estimator/baselines/lio_sam/imu_odometry.hpp"
#include "estimator/baselines/lio_sam/scan_features.hpp"
#include "estimator/baselines/pose_graph/loop_closure.hpp"

namespace aims::lio_sam {

/// Angles of R = R_z(yaw) R_y(pitch) R_x(roll) [rad].
struct RollPitchYaw {
  double roll = 0.0;
  double pitch = 0.0;
  double yaw = 0.0;
};

RollPitchYaw angles_of(const Eigen::Quaterniond& rotation);

Eigen::Quaterniond rotation_of(const RollPitchYaw& angles);

/// The rotation with roll and pitch moved towards those of an attitude by `weight`, each on its
/// own; unchanged when the attitude points steeply up or down.
Eigen::Quaterniond levelled(const Eigen::Quaterniond& rotation, const RollPitchYaw& attitude,
                            double weight);

/// LOAM's scan to map with 30 iterations at most.
features::SolverConfig solver_config();

/// Registration of scans to keyframes (LIO-SAM, section III-C); defaults of the published program.
struct MappingConfig {
  double min_interval = 0.15;      ///< between two scans that are registered [s]
  int min_scan_edges = 10;         ///< a scan needs more edges to be registered
  int min_scan_surface = 100;      ///< likewise, surface points
  double edge_voxel = 0.2;         ///< [m]
  double surface_voxel = 0.4;      ///< [m]
  double keyframe_distance = 1.0;  ///< a scan this far from the last keyframe becomes one [m]
  double keyframe_angle = 0.2;     ///< or this far in roll, pitch or yaw [rad]
  double submap_radius = 50.0;     ///< keyframes nearer to the last one make the map [m]
  double keyframe_voxel = 2.0;     ///< one keyframe is used per voxel of their positions [m]
  double recent = 10.0;            ///< and all that are younger [s]
  double attitude_weight = 0.01;   ///< of the IMU's roll and pitch in the pose
  double odometry_weight = 0.1;    ///< likewise, in the pose that the IMU odometry is given
  features::MapMatchConfig matching = {.min_map_edges = 0, .min_map_planes = 0};
  features::SolverConfig solver = solver_config();
  pose_graph::PoseGraphConfig graph;
  pose_graph::LoopConfig loop;
};

void describe(Fields& fields, MappingConfig& config);

/// What else is known of a scan at its begin.
struct ScanPrior {
  bool imu_available = false;
  RollPitchYaw attitude;         ///< as the IMU reports it
  std::optional<Pose> odometry;  ///< of the LiDAR, by the IMU odometry
};

/// A registered scan.
struct RegisteredScan {
  features::SolverResult solver;
  int edges = 0;  ///< after averaging
  int surface = 0;
  bool degenerate = false;
  bool keyframe = false;
  bool rejected = false;   ///< the result was of no use, the pose is that before the scan
  Pose T_map_lidar;        ///< begin of the scan
  LidarOdometry odometry;  ///< the same without corrections by loops
};

/// Registers scans to the keyframes around them and keeps the graph of keyframes.
class Mapping {
 public:
  explicit Mapping(const MappingConfig& config);

  /// Whether a scan that begins at `stamp` is registered.
  bool is_due(Time stamp) const;

  /// Registers the features of a scan.
  RegisteredScan update(Time stamp, const ScanFeatures& scan, const ScanPrior& prior);

  const features::KeyframeMap& map() const { return keyframes_.map(); }
  int loops() const { return keyframes_.loops(); }

 private:
  void guess(const ScanPrior& prior);
  void guess_from_rotation(const Eigen::Quaterniond& attitude);
  void build_submap(Time stamp);
  bool register_scan(const features::FeatureCloud& edges, const features::FeatureCloud& surface,
                     const ScanPrior& prior, RegisteredScan& result);
  bool is_keyframe() const;
  void add_keyframe(Time stamp, features::FeatureCloud edges, features::FeatureCloud surface);
  LidarOdometry odometry(Time stamp, const ScanPrior& prior);

  MappingConfig config_;
  pose_graph::KeyframeGraph keyframes_;
  features::MapReference reference_;
  std::vector<int> submap_;  ///< keyframes in `reference_`

  std::optional<Time> last_stamp_;
  Pose pose_;        ///< T_map_lidar of the last scan
  Pose registered_;  ///< the same before corrections by loops
  bool degenerate_ = false;
  Eigen::Quaterniond last_attitude_ = Eigen::Quaterniond::Identity();
  std::optional<Pose> last_odometry_;  ///< of the IMU odometry
  Pose before_;                        ///< `pose_` before the present scan
  std::optional<Pose> incremental_;    ///< poses without corrections by loops
};

}  // namespace aims::lio_sam
