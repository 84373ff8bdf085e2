// SPDX-License-Identifier: BSD-3-Clause
#include "lab/fidelity/range_residuals.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "sim/environment/scene_config.hpp"
#include "sim/sensors/lidar.hpp"
#include "tests/sim/sensors/closed_room.hpp"

namespace aims {
namespace {

/// Poses of a LiDAR that walks and turns along the corridor.
Trajectory moving_poses() {
  Trajectory poses;
  for (int i = 0; i <= 44; ++i) {
    const double t = 0.0025 * i;
    poses.push_back(
        {from_seconds(t), {so3_exp({0.05 * std::sin(20.0 * t), 0.0, t}), {20.0 + t, 0.05, 0.45}}});
  }
  return poses;
}

Scene corridor_with_people() {
  SceneConfig config;
  config.corridor.clutter.density = 0.5;
  config.people.count = 3;
  return build_scene(config, 1);
}

TEST(RangeResiduals, AreZeroForAScanWithoutErrors) {
  const RayCaster caster(corridor_with_people());
  Lidar lidar(testing::flawless_lidar(), caster, 1);
  const Trajectory poses = moving_poses();
  const LidarScan scan = lidar.scan(0, poses);
  const auto residuals = range_residuals(scan, poses, caster);
  ASSERT_EQ(residuals.size(), scan.points.size());
  // A beam that grazes an edge may fall on its other side after rounding to float.
  const auto exact = std::ranges::count_if(
      residuals, [](const RangeResidual& each) { return std::abs(each.residual) < 1e-3; });
  EXPECT_GT(static_cast<double>(exact), 0.9995 * static_cast<double>(residuals.size()));
}

TEST(RangeResiduals, ShowTheConfiguredOffsetAndNoise) {
  const testing::ClosedRoom room;
  const RayCaster caster(room.scene());
  LidarConfig config = testing::flawless_lidar();
  config.range_sigma = 0.01;
  config.calibration.range_bias_sigma = 0.02;
  Lidar lidar(config, caster, 3);
  const double bias = lidar.calibration().range_bias;
  ASSERT_GT(std::abs(bias), 0.003);
  const auto residuals = range_residuals(lidar.scan(0, room.poses()), room.poses(), caster);
  int returns = 0;
  for (const ResidualBin& bin : residual_bins(residuals)) {
    returns += bin.returns;
    if (bin.returns < 500) continue;
    EXPECT_NEAR(bin.mean, bias, 4.0 * 0.01 / std::sqrt(bin.returns));
    EXPECT_NEAR(bin.std, 0.01, 4.0 * 0.01 / std::sqrt(2.0 * bin.returns));
    EXPECT_EQ(bin.share_beyond, 0.0);
  }
  EXPECT_EQ(returns, static_cast<int>(residuals.size()));
}

TEST(ResidualBins, SetLargeResidualsApart) {
  const std::vector<RangeResidual> residuals = {
      {3.0, 1.0, 0.02}, {3.0, 1.0, 0.04}, {3.0, 1.0, -0.5}, {3.0, 1.0, 2.0}, {30.0, 0.05, 0.01}};
  const auto bins = residual_bins(residuals);
  ASSERT_EQ(bins.size(), 2U);
  EXPECT_EQ(bins[0].range_begin, 2.0);
  EXPECT_EQ(bins[0].incidence_end_deg, 30.0);
  EXPECT_EQ(bins[0].returns, 4);
  EXPECT_NEAR(bins[0].mean, 0.03, 1e-12);
  EXPECT_NEAR(bins[0].std, 0.01, 1e-9);
  EXPECT_EQ(bins[0].share_beyond, 0.5);
  EXPECT_EQ(bins[1].incidence_begin_deg, 85.0);
}

}  // namespace
}  // namespace aims
