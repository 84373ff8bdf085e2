// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "estimator/baselines/fast_lio2/config.hpp"
#include "estimator/baselines/fast_lio2/point_map.hpp"
#include "estimator/baselines/fast_lio2/registration.hpp"
#include "estimator/baselines/fast_lio2/scan_points.hpp"
#include "estimator/filter/queued_estimator.hpp"
#include "estimator/interface/diagnostics.hpp"

namespace aims::fast_lio2 {

/// FAST-LIO2: an iterated Kalman filter on IMU and LiDAR, which matches the points of each scan
/// with planes of a map of points (docs/baselines/fast_lio2.md). Its world is the IMU's frame at
/// the start: roll and pitch are not relative to gravity.
class FastLio2 : public QueuedEstimator {
 public:
  FastLio2(const Config& config, const SensorRig& rig);

  std::vector<Eigen::Vector3f> map_points() const override { return map_.points(); }

  /// Estimate after the last processed scan.
  const Belief& belief() const { return belief_; }

 private:
  void process_scan(const LidarScanPtr& scan) override { process(*scan); }
  void process(const LidarScan& scan);
  bool start(const std::vector<ImuSample>& samples);
  void predict(const std::vector<ImuSample>& samples, Time begin, Time end);
  void step(const Inertial& input, Time until);
  Knot knot(const Inertial& input, Time stamp) const;
  void match(const std::vector<Eigen::Vector3f>& points, Time stamp);
  void record(const Update& update, std::size_t points, Time stamp);

  Config config_;
  Belief belief_;
  PointMap map_;
  LocalCube cube_;

  bool started_ = false;
  int samples_ = 0;                                       ///< averaged at the start
  Eigen::Vector3d mean_force_ = Eigen::Vector3d::Zero();  ///< of the start [m/s^2]
  Eigen::Vector3d mean_rate_ = Eigen::Vector3d::Zero();   ///< likewise [rad/s]
  Time time_ = 0;                                         ///< of the belief
  std::optional<ImuSample> last_sample_;
  std::vector<Knot> knots_;  ///< of the present scan
};

}  // namespace aims::fast_lio2
