// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "estimator/baselines/bievr/bump_map.hpp"
#include "estimator/baselines/bievr/config.hpp"
#include "estimator/baselines/bievr/inertial_window.hpp"
#include "estimator/baselines/bievr/registration.hpp"
#include "estimator/baselines/bievr/sampling.hpp"
#include "estimator/filter/queued_estimator.hpp"

namespace aims::bievr {

/// BIEVR-LIO: scans are registered with images of heights over the planes of voxels, starting at
/// the prediction of the IMU; its biases and the velocity follow from the registered poses
/// (docs/baselines/bievr.md). The z axis of its world is vertical.
class Bievr : public QueuedEstimator {
 public:
  Bievr(const Config& config, const SensorRig& rig);

  std::vector<Eigen::Vector3f> map_points() const override { return map_.points(); }

 private:
  void process_scan(const LidarScanPtr& scan) override { process(*scan); }
  void process(const LidarScan& scan);
  bool start(Time end);
  void follow(const LidarScan& scan);
  Registered match(const Sample& sample, const NavState& prediction);
  void restart();
  void map(const std::vector<Eigen::Vector3d>& points);
  void learn(const NavState& prediction, const Preintegration& motion, const NavState& from);
  void record(const Sample& sample, const Registered& registered);

  Config config_;
  BumpMap map_;
  InertialWindow window_;

  bool started_ = false;
  std::optional<Time> first_sample_;  ///< of the start
  Time time_ = 0;                     ///< of the state
  NavState state_;                    ///< of the body in the world
  InertialState inertial_;
  std::vector<InertialSegment> segments_;  ///< since the state
};

}  // namespace aims::bievr
