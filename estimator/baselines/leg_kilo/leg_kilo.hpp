// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <deque>
#include <limits>
#include <optional>
#include <vector>

#include "estimator/baselines/leg_kilo/observations.hpp"
#include "estimator/baselines/leg_kilo/plane_map.hpp"
#include "estimator/baselines/leg_kilo/scan_groups.hpp"
#include "estimator/filter/queued_estimator.hpp"
#include "estimator/interface/diagnostics.hpp"

namespace aims::leg_kilo {

/// What a scan did to the filter.
struct ScanReport {
  int points = 0;   ///< after the voxel filter
  int updates = 0;  ///< by points; 0: none lay on a plane
  int imu_samples = 0;
  int standing_feet = 0;              ///< at all these samples together
  std::vector<PointOnPlane> matches;  ///< at the states before their updates
};

/// Leg-KILO: one Kalman filter on IMU, standing feet and points on the planes of a map of voxels
/// (docs/baselines/leg_kilo.md). It takes the points of a scan in small groups, in order of their
/// firing, so nothing is deskewed. Its world is the IMU's frame at the start: roll and pitch are
/// not relative to gravity.
class LegKilo : public QueuedEstimator {
 public:
  LegKilo(const Config& config, const SensorRig& rig);

  std::vector<Eigen::Vector3f> map_points() const override { return map_.plane_centres(); }

  /// Estimate after the last processed scan.
  const Belief& belief() const { return belief_; }

 private:
  void process_scan(const LidarScanPtr& scan) override { process(*scan); }
  void process_legs(const LegOdometrySample& sample) override;
  void process(const LidarScan& scan);
  bool start(const LidarScan& scan, const std::vector<ImuSample>& samples);
  bool register_scan(const LidarScan& scan, const std::vector<ImuSample>& samples,
                     ScanReport& report);
  void predict(Time stamp);
  void observe(const ImuSample& sample, ScanReport& report);
  void register_group(const PointGroup& group, ScanReport& report);
  std::vector<StandingFoot> feet_at(Time stamp);
  void record(const ScanReport& report, Time stamp);

  Config config_;
  Belief belief_;
  PlaneMap map_;
  ContactHysteresis contacts_;

  bool started_ = false;
  double force_scale_ = 1.0;  ///< makes the mean specific force of the start as long as gravity
  Time predicted_ = 0;        ///< time of the state
  Time updated_ = 0;          ///< time of the last update, from which the covariance is predicted
  std::optional<Time> last_sample_;     ///< newest IMU sample taken
  std::deque<LegOdometrySample> legs_;  ///< in order of stamp
};

}  // namespace aims::leg_kilo
