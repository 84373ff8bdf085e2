// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <span>

#include "core/measurements.hpp"
#include "estimator/baselines/lins/config.hpp"

namespace aims::lins {

/// What came of a scan.
struct OdometryResult {
  enum class Outcome {
    kStarting,    ///< no pose yet
    kStarted,     ///< the first pose, from two scans
    kUpdated,     ///< the filter's
    kRegistered,  ///< the filter diverged: from the two scans alone
    kUnchanged,   ///< too few features
    kRejected,    ///< not finite or too far: the filter starts again with the next scans
  };
  Outcome outcome = Outcome::kStarting;
  Update update;
};

/// Motion of the LiDAR from the features of consecutive scans and the IMU: an iterated Kalman
/// filter on the state relative to the last scan (LINS, section III).
class RobocentricOdometry {
 public:
  explicit RobocentricOdometry(const Config& config) : config_(config) {}

  /// The next scan, to which the IMU predicts until `until`, and whose newest sample is
  /// `newest`; samples are in LiDAR axes. Moves the scan's features to its end.
  OdometryResult update(features::RingFeatures& scan, std::span<const ImuSample> samples,
                        const ImuSample& newest, Time until);

  /// The pose at the end of the last scan: a level frame at the LiDAR of the first one.
  const Pose& pose() const { return T_world_lidar_; }

  const Belief& belief() const { return belief_; }

 private:
  enum class Phase { kNoScan, kOneScan, kRunning };

  void predict(std::span<const ImuSample> samples, Time until);
  OdometryResult start(features::RingFeatures& scan, const ImuSample& newest);
  OdometryResult correct(features::RingFeatures& scan);
  features::FeatureMatches match(const features::RingFeatures& scan, const Pose& motion) const;
  Pose scan_match(const features::RingFeatures& scan, const Pose& initial) const;
  void set_reference(features::RingFeatures& scan, const Pose& motion);

  Config config_;
  Phase phase_ = Phase::kNoScan;
  Belief belief_;
  Pose T_world_lidar_;
  features::RingReference edges_;
  features::RingReference planes_;
  Inertial input_;      ///< last measured
  Time time_ = 0;       ///< until which the IMU has predicted
  Time last_time_ = 0;  ///< likewise, at the last scan
};

}  // namespace aims::lins
