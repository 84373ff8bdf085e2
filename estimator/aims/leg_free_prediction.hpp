// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "estimator/filter/imu_history.hpp"
#include "estimator/filter/kalman_update.hpp"

namespace aims {

/// The prediction of the IMU alone from the belief after the last scan: x_{k|k-1} and P_{k|k-1} of
/// eqs. (5) and (6) as the paper defines them, "the IMU-predicted state". The filter's own
/// prediction at the end of a scan also holds the leg updates since the last one (about 20).
///
/// A scan without an update restarts it too: it then continues from what the filter holds, so that
/// it always spans the time since the last scan.
class LegFreePrediction {
 public:
  explicit LegFreePrediction(const ImuPropagationConfig& config) : config_(config) {}

  /// Continues from `belief` at `stamp`.
  void restart(const Belief& belief, Time stamp);

  /// Propagates to `stamp`; nothing before the first restart. Call at least once per second, while
  /// `imu` holds the samples.
  void predict_to(Time stamp, const ImuHistory& imu);

  /// The prediction; null before the first scan.
  const Belief* belief() const { return belief_ ? &*belief_ : nullptr; }

 private:
  ImuPropagationConfig config_;
  Time time_ = 0;  ///< of the belief
  std::optional<Belief> belief_;
  std::vector<InertialSegment> segments_;
};

/// C_IL, eq. (6), of the pose (6-D): the innovation from `prediction` to the state `lidar` that the
/// scan makes of it, normalized by the predicted covariance.
double lidar_consistency(const NominalState& lidar, const Belief& prediction);

}  // namespace aims
