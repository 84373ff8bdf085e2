// SPDX-License-Identifier: BSD-3-Clause
// The estimate between corrections, for those who need it at the rate of the IMU.
#include <algorithm>

#include "estimator/aims/eskf_estimator.hpp"

namespace aims {

std::optional<MotionEstimate> EskfEstimator::motion(Time until) const {
  if (!started_) return std::nullopt;
  const ImuHistory& imu = queue_.imu();
  MotionEstimate motion;
  motion.stamp = std::max(time_, std::min(until, imu.newest().value_or(time_)));
  Belief belief = belief_;
  InertialSegment last;
  std::vector<InertialSegment> segments;
  if (motion.stamp > time_) imu.segments(time_, motion.stamp, segments);
  for (const InertialSegment& segment : segments) {
    belief.state = propagate_state(belief.state, segment, to_seconds(segment.end - segment.begin),
                                   config_.imu.gravity);
    last = segment;
  }
  if (!segments.empty()) {
    // One step for the covariance: over a tenth of a second it hardly depends on the steps.
    const Belief after = propagate(belief_, last, to_seconds(motion.stamp - time_), config_.imu);
    belief.covariance = after.covariance;
    belief.excess = after.excess;
  }
  const ErrorMatrix P = stated_covariance(belief);
  motion.T_odom_body = belief.state.T_odom_body();
  motion.velocity = belief.state.velocity;
  const Eigen::Vector3d rate =
      segments.empty() ? imu.angular_velocity_at(motion.stamp).value_or(belief.state.gyro_bias)
                       : last.angular_velocity;
  motion.angular_velocity = rate - belief.state.gyro_bias;
  motion.covariance = P.topLeftCorner<9, 9>();
  const double white = imu.noise().density().gyro;
  motion.rate_covariance = block(P, ErrorState::kGyroBias, ErrorState::kGyroBias) +
                           white * white * rig_.imu_rate_hz * Eigen::Matrix3d::Identity();
  return motion;
}

}  // namespace aims
