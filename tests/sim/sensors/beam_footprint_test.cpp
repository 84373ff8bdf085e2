// SPDX-License-Identifier: BSD-3-Clause
#include "sim/sensors/beam_footprint.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "sim/sensors/fisher_information.hpp"
#include "sim/sensors/lidar.hpp"
#include "tests/sim/sensors/closed_room.hpp"

namespace aims {
namespace {

using Eigen::Vector3d;

constexpr double kBoard = 5.0;  ///< distance of the near board, which covers y < 0 [m]

/// A VLP-16 with its footprint, without other errors; rings close to the horizon.
LidarConfig wide_beam() {
  LidarConfig config = testing::flawless_lidar();
  config.elevation_min_deg = -2.0;
  config.elevation_max_deg = 2.0;
  config.beam = {.divergence_horizontal = 0.003,
                 .divergence_vertical = 0.0012,
                 .exit_width = 0.0127,
                 .exit_height = 0.0095,
                 .pulse_length = 1.0};
  return config;
}

/// A board with its edge at y = 0 and a wall behind it.
Scene step_edge(double wall) {
  Scene scene;
  Solid near;
  near.T_world_solid.translation = {kBoard + 0.05, -50.0, 0.0};
  near.half_extents = {0.05, 50.0, 50.0};
  Solid far;
  far.T_world_solid.translation = {wall + 0.05, 0.0, 0.0};
  far.half_extents = {0.05, 50.0, 50.0};
  scene.solids = {near, far};
  scene.floor.min_corner = {-1000.0, 0.0};
  scene.floor.max_corner = {-999.0, 1.0};
  return scene;
}

/// Range of the strongest return, from 400 parts of the footprint and the two planes alone.
double integrated_range(const LidarBeamConfig& beam, const Vector3d& direction, double wall) {
  constexpr int kParts = 20;
  const Vector3d across = Vector3d::UnitZ().cross(direction).normalized();
  const Vector3d up = direction.cross(across);
  double power[2] = {0.0, 0.0};
  double moment[2] = {0.0, 0.0};
  for (int i = 0; i < kParts * kParts; ++i) {
    const double u = (i % kParts + 0.5) / kParts - 0.5;
    const double v = (i / kParts + 0.5) / kParts - 0.5;
    const Vector3d from = u * beam.exit_width * across + v * beam.exit_height * up;
    const Vector3d towards =
        (direction + u * beam.divergence_horizontal * across + v * beam.divergence_vertical * up)
            .normalized();
    const double to_board = (kBoard - from.x()) / towards.x();
    const bool on_board = from.y() + to_board * towards.y() < 0.0;
    const double range = on_board ? to_board : (wall - from.x()) / towards.x();
    const int echo = wall - kBoard < beam.pulse_length || on_board ? 0 : 1;
    power[echo] += towards.x() / (range * range);
    moment[echo] += towards.x() / (range * range) * range;
  }
  const int strongest = power[1] > power[0] ? 1 : 0;
  return moment[strongest] / power[strongest];
}

struct EdgeReturn {
  double measured = 0.0;    ///< distance along x [m]
  double integrated = 0.0;  ///< [m]
  double azimuth = 0.0;     ///< [rad]
};

/// Returns within one degree of the edge, with the beams in many places relative to it.
std::vector<EdgeReturn> edge_returns(LidarConfig config, double wall) {
  const RayCaster caster(step_edge(wall));
  const Trajectory still = {{0, Pose{}}};
  std::vector<EdgeReturn> returns;
  for (int i = 0; i < 25; ++i) {
    config.start_azimuth_deg = 180.0 + 0.2 * i / 25.0;
    const LidarScan scan = Lidar(config, caster, 1).scan(0, still);
    for (const LidarPoint& point : scan.points) {
      const Vector3d p = point.position.cast<double>();
      const double azimuth = std::atan2(p.y(), p.x());
      if (std::abs(azimuth) > std::numbers::pi / 180.0) continue;
      const Vector3d direction = p.normalized();
      returns.push_back(
          {p.x(), integrated_range(config.beam, direction, wall) * direction.x(), azimuth});
    }
  }
  return returns;
}

bool between(double x, double wall) { return x > kBoard + 0.02 && x < wall - 0.02; }

TEST(BeamFootprint, MixesTheRangesOfTwoNearSurfacesAsTheIntegratedFootprint) {
  const double wall = kBoard + 0.6;
  int mixed = 0;
  int expected_mixed = 0;
  testing::Spread error, measured, expected;
  for (const EdgeReturn& each : edge_returns(wide_beam(), wall)) {
    error.add(each.measured - each.integrated);
    EXPECT_LT(std::abs(each.measured - each.integrated), 0.6 / 16.0 + 0.01);
    if (between(each.measured, wall)) {
      ++mixed;
      measured.add(each.measured);
    }
    if (between(each.integrated, wall)) {
      ++expected_mixed;
      expected.add(each.integrated);
    }
  }
  // Of 25 x 16 edges, each in (3 mrad + 12.7 mm / 5 m) / 3.49 mrad = 1.59 firings.
  EXPECT_NEAR(expected_mixed, 25 * 16 * 1.59, 0.1 * 25 * 16 * 1.59);
  EXPECT_NEAR(mixed, expected_mixed, 0.05 * expected_mixed);
  EXPECT_NEAR(measured.mean(), expected.mean(), 0.01);
  EXPECT_NEAR(measured.std(), expected.std(), 0.01);
  EXPECT_LT(std::sqrt(error.squares / error.count), 0.01);
}

TEST(BeamFootprint, ReportsTheStrongerOfTwoFarSurfacesAndWidensTheNearOne) {
  const double wall = kBoard + 4.0;
  int agree = 0;
  int beyond_edge = 0;
  int expected_beyond = 0;
  const std::vector<EdgeReturn> returns = edge_returns(wide_beam(), wall);
  for (const EdgeReturn& each : returns) {
    EXPECT_FALSE(between(each.measured, wall)) << each.measured;
    if (std::abs(each.measured - each.integrated) < 0.02) ++agree;
    beyond_edge += each.measured < kBoard + 0.1 && each.azimuth > 0.0 ? 1 : 0;
    expected_beyond += each.integrated < kBoard + 0.1 && each.azimuth > 0.0 ? 1 : 0;
  }
  EXPECT_GT(agree, 0.99 * static_cast<double>(returns.size()));
  EXPECT_GT(expected_beyond, 50);
  EXPECT_NEAR(beyond_edge, expected_beyond, 0.1 * expected_beyond);
}

TEST(BeamFootprint, AnEdgeBetweenRingsIsMixedToo) {
  Scene scene = step_edge(kBoard + 0.5);
  scene.solids[0].T_world_solid.translation = {kBoard + 0.05, 0.0, -50.0};  // covers z < 0
  const RayCaster caster(scene);
  LidarConfig config = wide_beam();
  int mixed = 0;
  int beams = 0;
  for (int i = 0; i < 50; ++i) {  // ring 8 passes through the edge
    config.elevation_min_deg = -2.1333 + (i - 25) * 0.005;
    config.elevation_max_deg = config.elevation_min_deg + 4.0;
    const LidarScan scan = Lidar(config, caster, 1).scan(0, {{0, Pose{}}});
    for (const LidarPoint& point : scan.points) {
      if (std::abs(point.position.y()) > 0.1 || point.position.x() < 0.0F) continue;
      if (point.ring == 8) ++beams;
      mixed += between(point.position.x(), kBoard + 0.5) ? 1 : 0;
    }
  }
  // The footprint is 1.2 mrad + 9.5 mm / 5 m = 3.1 mrad = 0.178 deg high; ring 8 sweeps 0.25 deg.
  EXPECT_NEAR(static_cast<double>(mixed) / beams, 0.178 / 0.25, 0.1);
}

TEST(BeamFootprint, ALineMixesNothing) {
  LidarConfig config = wide_beam();
  config.beam = {};
  const double wall = kBoard + 0.6;
  const auto returns = edge_returns(config, wall);
  ASSERT_FALSE(returns.empty());
  for (const EdgeReturn& each : returns) {
    ASSERT_FALSE(between(each.measured, wall)) << each.measured;
  }
}

TEST(BeamFootprint, ChangesNothingInARoomWithoutSteps) {
  const testing::ClosedRoom room;
  const RayCaster caster(room.scene());
  const LidarConfig line = testing::flawless_lidar();
  LidarConfig wide = line;
  wide.beam = wide_beam().beam;
  const LidarScan a = Lidar(line, caster, 1).scan(0, room.poses());
  const LidarScan b = Lidar(wide, caster, 1).scan(0, room.poses());
  ASSERT_EQ(a.points.size(), b.points.size());
  for (std::size_t i = 0; i < a.points.size(); ++i) {
    ASSERT_EQ(a.points[i].position, b.points[i].position);
    ASSERT_EQ(a.points[i].intensity, b.points[i].intensity);
  }
}

TEST(BeamFootprint, AnEdgeGivesNoInformation) {
  const double wall = kBoard + 0.6;
  const RayCaster caster(step_edge(wall));
  LidarConfig config = wide_beam();
  config.range_sigma = 0.01;
  ScanTruth truth;
  const LidarScan scan = Lidar(config, caster, 1).scan(0, {{0, Pose{}}}, &truth);
  ASSERT_EQ(truth.range_sigmas.size(), scan.points.size());
  int edges = 0;
  for (std::size_t i = 0; i < scan.points.size(); ++i) {
    const bool on_edge = std::isinf(truth.range_sigmas[i]);
    edges += on_edge ? 1 : 0;
    if (!on_edge) {
      ASSERT_FLOAT_EQ(truth.range_sigmas[i], 0.01F);
      ASSERT_FALSE(between(truth.points[i].x(), wall));
    }
  }
  EXPECT_GT(edges, 10);
  EXPECT_EQ(scan_information(0, truth, Pose{}, 0.01).returns,
            static_cast<int>(scan.points.size()) - edges);
}

TEST(StrongestEcho, IsTheMeanOfItsPartsWeightedByPower) {
  HitPacket hits;
  LaneValues strength;
  for (int i = 0; i < kRayPacketSize; ++i) {
    hits.surface[i] = i < 4 ? 0 : (i < 12 ? 1 : -1);
    hits.distance[i] = i < 4 ? 2.0F : (i < 12 ? 4.0F : std::numeric_limits<float>::infinity());
    strength[i] = 0.5F;
  }
  // Powers: 4 parts / 4 m^2 = 1 against 8 parts / 16 m^2 = 0.5.
  const Echo apart = strongest_echo(hits, strength, 1.0);
  EXPECT_FLOAT_EQ(apart.distance, 2.0F);
  EXPECT_FLOAT_EQ(apart.strength, 0.5F * 4.0F / 16.0F);
  EXPECT_LT(apart.lane, 4);
  const Echo joined = strongest_echo(hits, strength, 3.0);
  EXPECT_FLOAT_EQ(joined.distance, (1.0F * 2.0F + 0.5F * 4.0F) / 1.5F);
  EXPECT_FLOAT_EQ(joined.strength, 0.5F * 1.5F / 16.0F * joined.distance * joined.distance);
  hits.surface.fill(-1);
  EXPECT_EQ(strongest_echo(hits, strength, 1.0).lane, -1);
}

}  // namespace
}  // namespace aims
