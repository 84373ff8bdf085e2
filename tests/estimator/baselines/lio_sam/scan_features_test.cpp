// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/baselines/lio_sam/scan_features.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "estimator/baselines/lio_sam/mapping.hpp"
#include "tests/estimator/baselines/room_scan.hpp"

namespace aims::lio_sam {
namespace {

using aims::testing::pose_of;
using aims::testing::room;
using aims::testing::scan_in;
using Eigen::Vector3d;

const test::CorridorShape kRoom = room(12.0, 9.0, 4.0);
const Pose kStart{Eigen::Quaterniond::Identity(), {0.3, -0.4, 1.6}};

/// Samples of a constant rate, whose first is at `begin`.
std::vector<ImuSample> turning(const Vector3d& rate, Time begin = 0) {
  std::vector<ImuSample> samples;
  for (Time t = begin; t <= 120 * kMillisecond; t += 10 * kMillisecond) {
    samples.push_back({t, rate, {0.0, 0.0, 9.81}});
  }
  return samples;
}

TEST(LioSamGyroRotation, IsLinearBetweenSamplesAndConstantOutside) {
  std::vector<ImuSample> samples = turning({0.0, 0.0, 1.0}, 5 * kMillisecond);
  samples[2].angular_velocity.z() = 3.0;
  const GyroRotation rotation(samples, 100 * kMillisecond);
  EXPECT_NEAR(rotation.angles_at(0).z(), 0.0, 1e-12);
  EXPECT_NEAR(rotation.angles_at(15 * kMillisecond).z(), 0.01, 1e-12);
  EXPECT_NEAR(rotation.angles_at(20 * kMillisecond).z(), 0.01 + 0.015, 1e-12);
  EXPECT_NEAR(rotation.angles_at(25 * kMillisecond).z(), 0.04, 1e-12);
  // Samples later than 10 ms after the end are left out.
  EXPECT_NEAR(rotation.angles_at(kSecond).z(), 0.12, 1e-12);
  EXPECT_FALSE(GyroRotation({samples[0]}, 100 * kMillisecond).available());
}

TEST(LioSamAttitude, AnglesAndRotationAreInverse) {
  const RollPitchYaw angles{0.3, -0.6, 2.5};
  const RollPitchYaw found = angles_of(rotation_of(angles));
  EXPECT_NEAR(found.roll, 0.3, 1e-12);
  EXPECT_NEAR(found.pitch, -0.6, 1e-12);
  EXPECT_NEAR(found.yaw, 2.5, 1e-12);
  const Vector3d x = rotation_of({0.0, 0.2, 0.0}) * Vector3d::UnitX();
  EXPECT_NEAR(x.z(), -std::sin(0.2), 1e-12) << "pitch is down";
}

TEST(LioSamAttitude, LevellingMovesRollAndPitchByTheWeight) {
  const RollPitchYaw found =
      angles_of(levelled(rotation_of({0.1, 0.2, 1.0}), {0.3, -0.2, -2.0}, 0.25));
  EXPECT_NEAR(found.roll, 0.15, 1e-12);
  EXPECT_NEAR(found.pitch, 0.1, 1e-12);
  EXPECT_NEAR(found.yaw, 1.0, 1e-12);
  const RollPitchYaw steep =
      angles_of(levelled(rotation_of({0.1, 0.2, 1.0}), {0.3, 1.5, 0.0}, 0.25));
  EXPECT_NEAR(steep.roll, 0.1, 1e-12);
}

TEST(LioSamRings, DeskewingUndoesATurnDuringTheScan) {
  const double turn = 0.08;
  const LidarScan scan = scan_in(kRoom, kStart, pose_of({0.0, 0.0, 0.0}, {0.0, 0.0, turn}));
  const GyroRotation rotation(turning({0.0, 0.0, turn / 0.1}), 100 * kMillisecond);
  const auto largest_gap = [](const std::vector<features::RangeRing>& rings) {
    double largest = 0.0;  // of the far walls' height from their plane
    for (const features::RangeRing& ring : rings) {
      for (const features::FeaturePoint& each : ring.points) {
        const Eigen::Vector3d p = kStart * each.position.cast<double>();
        const double outside =
            std::max({std::abs(p.x()) - 6.0, std::abs(p.y()) - 4.5, -p.z(), p.z() - 4.0});
        largest = std::max(largest, std::abs(outside));
      }
    }
    return largest;
  };
  EXPECT_GT(largest_gap(deskewed_rings(scan, GyroRotation({}, 0), {})), 0.1);
  EXPECT_LT(largest_gap(deskewed_rings(scan, rotation, {})), 1e-3);
}

TEST(LioSamRings, AreInOrderOfColumnsAndKeepTheFirstReturnOfACell) {
  LidarScan scan = scan_in(kRoom, kStart);
  const std::size_t count = scan.points.size();
  for (std::size_t i = 0; i < count; ++i) {
    LidarPoint again = scan.points[i];
    again.position *= 1.5F;
    scan.points.push_back(again);
  }
  ImageConfig config;
  config.min_range = 2.0;
  for (const features::RangeRing& ring : deskewed_rings(scan, GyroRotation({}, 0), config)) {
    EXPECT_TRUE(std::is_sorted(ring.columns.begin(), ring.columns.end()));
    EXPECT_EQ(std::set<int>(ring.columns.begin(), ring.columns.end()).size(), ring.columns.size());
    EXPECT_GE(*std::min_element(ring.ranges.begin(), ring.ranges.end()), 2.0F);
    EXPECT_LT(*std::max_element(ring.ranges.begin(), ring.ranges.end()), 8.5F) << "first returns";
  }
}

/// Nearest pillar of a wall with square pillars, seen from 2 m.
features::RangeRing wall_with_step() {
  features::RangeRing ring;
  for (int column = 0; column < 300; ++column) {
    const float range = column < 150 ? 2.0F : 2.25F;  // no occlusion: less than 0.3 m
    ring.columns.push_back(column);
    ring.ranges.push_back(range);
    ring.points.push_back({Eigen::Vector3f(range, 0.01F * static_cast<float>(column), 0.0F)});
  }
  return ring;
}

TEST(LioSamFeatures, AStepIsAnEdgeTheRestIsSurface) {
  FeatureConfig config;
  config.edge_curvature = 0.1;
  config.surface_voxel = 0.01;
  const ScanFeatures features = scan_features({wall_with_step()}, config);
  ASSERT_GE(features.edges.size(), 1U);
  for (const features::FeaturePoint& edge : features.edges) {
    EXPECT_NEAR(edge.position.y(), 1.5, 0.06);
  }
  EXPECT_GT(features.surface.size(), 250U);
  EXPECT_EQ(features.points, 300);
}

TEST(LioSamFeatures, AnEdgeNeedsTheCurvature) {
  FeatureConfig config;
  config.edge_curvature = 1.6;  // (5 x 0.25)^2 = 1.5625 at the step
  EXPECT_TRUE(scan_features({wall_with_step()}, config).edges.empty());
  config.edge_curvature = 1.5;
  EXPECT_FALSE(scan_features({wall_with_step()}, config).edges.empty());
}

TEST(LioSamFeatures, ASectorHasAtMostSoManyEdges) {
  features::RangeRing ring = wall_with_step();
  for (int i = 0; i < ring.size(); ++i) {
    ring.ranges[i] = (i / 8) % 2 == 0 ? 2.0F : 2.25F;
  }
  FeatureConfig config;
  config.edge_curvature = 0.1;
  config.reliability.parallel_ratio = 1.0;
  config.max_edges = 2;
  EXPECT_EQ(scan_features({ring}, config).edges.size(), 12U);
}

}  // namespace
}  // namespace aims::lio_sam
