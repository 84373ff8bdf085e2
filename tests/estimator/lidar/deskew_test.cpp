// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/lidar/deskew.hpp"

#include <gtest/gtest.h>

namespace aims {
namespace {

constexpr double kGravity = 9.81;
const Pose kT_body_lidar{so3_exp({0.0, 0.1, 0.2}), {-0.15, 0.02, 0.15}};

TEST(Deskew, RestoresAStaticPointFromAMovingSensor) {
  // Truth: constant rate and force in body axes, for which propagation is exact.
  const std::vector<InertialSegment> segments = {
      {0, 40 * kMillisecond, {0.8, -0.5, 1.0}, {2.0, -1.0, 12.0}, true},
      {40 * kMillisecond, 100 * kMillisecond, {-0.6, 0.9, -0.2}, {-3.0, 0.5, 7.0}, true}};
  NominalState start;
  start.rotation = so3_exp({0.1, 0.2, 0.3});
  start.velocity = {0.7, 0.1, -0.2};
  const NominalState middle = propagate_state(start, segments[0], 0.04, kGravity);
  const NominalState end = propagate_state(middle, segments[1], 0.06, kGravity);
  ScanMotion motion;
  motion.assign(end, segments, kT_body_lidar, kGravity);

  const Eigen::Vector3d p_odom(12.0, -3.0, 1.0);
  for (int ms = 0; ms <= 100; ms += 5) {
    const Time time = ms * kMillisecond + 300'000 * (ms < 100);
    const double t = to_seconds(time);
    const NominalState then = t < 0.04 ? propagate_state(start, segments[0], t, kGravity)
                                       : propagate_state(middle, segments[1], t - 0.04, kGravity);
    const Eigen::Vector3d p_lidar = (then.T_odom_body() * kT_body_lidar).inverse() * p_odom;
    const Eigen::Vector3d expected = end.T_odom_body().inverse() * p_odom;
    EXPECT_LT((motion.deskew(p_lidar.cast<float>(), time) - expected.cast<float>()).norm(), 1e-4F)
        << ms << " ms";
  }
}

TEST(Deskew, ClampsTimesOutsideTheScan) {
  const std::vector<InertialSegment> segments = {
      {0, 100 * kMillisecond, {0.0, 0.0, 1.0}, {0.0, 0.0, kGravity}, true}};
  ScanMotion motion;
  motion.assign(NominalState{}, segments, Pose{}, kGravity);
  const Eigen::Vector3f p(5.0F, 0.0F, 0.0F);
  EXPECT_LT((motion.deskew(p, kSecond) - p).norm(), 1e-6F);
  EXPECT_LT((motion.deskew(p, -kSecond) - motion.deskew(p, 0)).norm(), 1e-6F);
}

TEST(Deskew, WorksWithoutSegments) {
  ScanMotion motion;
  motion.assign(NominalState{}, {}, Pose{}, kGravity);
  const Eigen::Vector3f p(5.0F, 1.0F, 2.0F);
  EXPECT_LT((motion.deskew(p, 17) - p).norm(), 1e-6F);
}

}  // namespace
}  // namespace aims
