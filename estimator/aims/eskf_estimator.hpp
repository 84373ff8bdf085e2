// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "estimator/aims/config.hpp"
#include "estimator/aims/health_monitor.hpp"
#include "estimator/aims/leg_free_prediction.hpp"
#include "estimator/aims/lidar_update.hpp"
#include "estimator/aims/robot_knowledge.hpp"
#include "estimator/filter/kalman_update.hpp"
#include "estimator/filter/motion_variance.hpp"
#include "estimator/filter/queued_estimator.hpp"
#include "estimator/ground/ground_constraint.hpp"
#include "estimator/interface/motion.hpp"
#include "estimator/legs/feet_odometry.hpp"
#include "estimator/legs/leg_states.hpp"
#include "estimator/legs/velocity_noise.hpp"
#include "estimator/legs/zero_velocity.hpp"
#include "estimator/lidar/deskew.hpp"
#include "estimator/lidar/scan_points.hpp"
#include "estimator/lidar/voxel_map.hpp"

namespace aims {

/// The error-state Kalman filter of all variants: the IMU predicts, leg odometry corrects at its
/// own stamps, the LiDAR at the end of each scan.
class EskfEstimator : public QueuedEstimator, public MotionSource {
 public:
  /// `rule`: of LidarUpdate.
  EskfEstimator(const EskfConfig& config, const SensorRig& rig,
                std::unique_ptr<const ScanRule> rule = nullptr);

  void consume(const Delivery& delivery) override;
  void finish() override;
  void forget_rows() override { keep_last_rows(result_); }
  std::vector<Eigen::Vector3f> map_points() const override { return map_.points(); }
  std::optional<MotionEstimate> motion(Time until) const override;
  const std::vector<Eigen::Vector3f>& registered_points() const override { return mapped_; }
  std::vector<LearnedQuantity> learned() const override;

  /// State and covariance after the last processed measurement, for consistency checks.
  const Belief& belief() const { return belief_; }

 private:
  bool start() override;
  void process_legs(const LegOdometrySample& sample) override;
  void process_scan(const LidarScanPtr& scan) override;
  void end_delivery() override { coast(); }
  void predict_to(Time stamp);
  void predict(Belief& belief, double duration);
  void meet_legs(bool by_feet);
  void note_contradictions();
  void report_pose_without_scan(Time stamp);
  void report_pose(Time stamp);
  void count_behind(const char* sensor, Time stamp);
  void coast();
  HealthRow judged_health();
  void repeat_lost_legs(Time until);
  void fuse_leg_velocity(const LegOdometrySample& sample);
  bool scans_measure_scale_of_feet() const;
  double excess_of_soft_joints() const;
  Eigen::Matrix3d covariance_of_soft_joints() const;
  double sigma_of_soft_legs() const;
  bool has_scans() const;
  LinearMeasurement reported_velocity(const LegOdometrySample& sample);
  bool fuse_zero_velocity(const LegOdometrySample& sample);
  void fuse_standing(const Eigen::Vector3d& rate);
  void prepare_points(const LidarScan& scan, ScanDiagnostics& diagnostics);
  void fuse_scan(ScanDiagnostics& diagnostics);
  void note_outage();
  void find_heading();
  void count_scan(const ScanDiagnostics& diagnostics);
  ScanDiagnostics diagnostics_of_prediction();
  void record_scan(ScanDiagnostics& diagnostics);
  void apply_calibration();
  bool legs_are_final() const;
  bool legs_are_known() const;
  void fuse_ground_constraint();
  bool near_start() const;
  void forget_map();
  void extend_map();
  /// The belief whose pose matches and maps scans.
  Belief& matching() { return mapping_ ? *mapping_ : belief_; }
  /// Where the points of the present scan lie in the map.
  Pose matched_pose() { return scan_pose(matching().state, calibration_); }
  /// `belief` becomes `updated`, unless that is not finite: then it is counted and rejected.
  void accept(Belief& belief, const Belief& updated);

  EskfConfig config_;
  ScanPoints points_;
  LidarUpdate lidar_update_;
  LegFreePrediction leg_free_;
  VoxelMap map_;
  GroundConstraint ground_;
  GroundLists ground_lists_;
  ZeroVelocityDetector zero_velocity_;
  HealthMonitor health_;
  RobotKnowledge robot_;

  bool started_ = false;
  bool stood_still_ = true;     ///< before the start
  Time time_ = 0;               ///< of the belief
  Belief first_belief_;         ///< at the start
  bool levelled_ = false;       ///< by level ground, at least once
  Time last_pose_ = 0;          ///< of the newest pose, or of the start
  Time last_correction_ = 0;    ///< stamp of the newest, or of the start
  std::optional<Time> judged_;  ///< arrival at which health was judged last
  Belief belief_;
  /// With `cross_validation`, until the leg scale is known: a belief that takes all information of
  /// a scan. Scans are mapped from it, where they fit the map, and not from an estimate that
  /// follows legs with a large scale error.
  std::optional<Belief> mapping_;
  std::optional<LegOdometrySample> last_leg_;  ///< its stamp advances while packets are repeated
  FeetOdometry feet_;
  StrideMeans stride_means_;
  LegVelocity velocity_;  ///< reported last
  VelocityNoise velocity_noise_;
  MotionVariance taken_by_legs_;          ///< variance that legs removed since the last scan
  double silence_ = 0.0;                  ///< of IMU and LiDAR until now [s]
  double outage_ = 0.0;                   ///< the longest since a heading was found, or 0 [s]
  double leg_innovation_ = kNotComputed;  ///< norm of the last one [m/s]
  int leg_updates_ = 0;

  std::vector<InertialSegment> segments_;
  CalibrationModel calibration_;         ///< of the present scan
  ScanMotion scan_motion_;               ///< of the present scan
  Time begin_ = 0;                       ///< of the estimate
  std::optional<Time> last_scan_;        ///< end of the last scan
  std::vector<Eigen::Vector3f> mapped_;  ///< points of the present scan, odometry frame
};

}  // namespace aims
