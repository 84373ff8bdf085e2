// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/aims/leg_free_prediction.hpp"

#include "estimator/degeneracy/degeneracy.hpp"
#include "estimator/filter/imu_propagation.hpp"

namespace aims {

void LegFreePrediction::restart(const Belief& belief, Time stamp) {
  belief_ = belief;
  time_ = stamp;
}

void LegFreePrediction::predict_to(Time stamp, const ImuHistory& imu) {
  if (!belief_ || stamp <= time_) return;
  imu.segments(time_, stamp, segments_);
  for (const InertialSegment& segment : segments_) {
    belief_ = propagate(*belief_, segment, to_seconds(segment.end - segment.begin), config_);
  }
  time_ = stamp;
}

double lidar_consistency(const NominalState& lidar, const Belief& prediction) {
  const ErrorVector y = boxminus(lidar, prediction.state);  // eq. (5)
  return consistency(pose_segment(y), pose_block(prediction.covariance));
}

}  // namespace aims
