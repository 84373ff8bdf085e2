// SPDX-License-Identifier: BSD-3-Clause
#include "bench/estimate/way_check.hpp"

#include <gtest/gtest.h>

namespace aims {
namespace {

/// A straight walk of 6 s at 0.5 m/s along x of the body, of whose way LiDAR odometry sees a part,
/// with a LiDAR that is turned by `mount` about z.
std::optional<ReadingWarning> warning_of(double legs, double seen, double mount = 0.0) {
  SensorRig rig;
  rig.T_body_lidar.rotation = yaw_rotation(mount);
  Trajectory path;
  std::vector<LegOdometrySample> samples;
  for (int i = 0; i <= 60; ++i) {
    const Eigen::Vector3d moved(0.05 * seen * i, 0.0, 0.0);
    path.push_back(
        {i * 100 * kMillisecond,
         {Eigen::Quaterniond::Identity(), rig.T_body_lidar.rotation.conjugate() * moved}});
  }
  for (int i = 0; i <= 600; ++i) {
    LegOdometrySample& sample = samples.emplace_back();
    sample.stamp = i * 10 * kMillisecond;
    sample.linear_velocity = {legs, 0.0, 0.0};
  }
  return check_way(std::vector<Trajectory>{path}, samples, rig);
}

TEST(WayCheck, LegsThatGoTheOppositeWayAreNamed) {
  const auto found = warning_of(-0.4, 1.0, 2.0);
  ASSERT_TRUE(found);
  EXPECT_NE(found->text.find("in 6 of 6 seconds that were compared the legs go the opposite way"),
            std::string::npos)
      << found->text;
  EXPECT_EQ(found->sensor, WarnedSensor::kLegs);
}

TEST(WayCheck, AWayThatAgreesOrIsHardlySeenIsNoMatter) {
  EXPECT_FALSE(warning_of(0.4, 1.0, 2.0));
  EXPECT_FALSE(warning_of(-0.4, 0.2)) << "as in a corridor";
  EXPECT_FALSE(warning_of(-0.1, 1.0)) << "no walk";
}

}  // namespace
}  // namespace aims
