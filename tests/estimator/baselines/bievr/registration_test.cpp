// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/baselines/bievr/registration.hpp"

#include <gtest/gtest.h>

#include "estimator/baselines/bievr/sampling.hpp"
#include "tests/estimator/baselines/bievr/wavy_wall.hpp"

namespace aims::bievr {
namespace {

using testing::WavyWall;

/// Points of the wall between its ends, and of a floor and an end wall, seen from a body at `pose`.
std::vector<Eigen::Vector3d> seen(const WavyWall& wall, const Pose& pose, double noise = 0.0,
                                  int seed = 3) {
  RandomStream random(static_cast<std::uint64_t>(seed), "seen");
  std::vector<Eigen::Vector3d> points;
  for (double z = 0.2; z < 1.8; z += 0.061) {
    for (double x = 0.5; x < 5.5; x += 0.067) {
      points.push_back(wall.at(x, z) + noise * random.normal() * Eigen::Vector3d::UnitY());
    }
  }
  for (Eigen::Vector3d& p : points) p = pose.inverse() * p;
  return points;
}

BumpMap wall_map(const WavyWall& wall, const MapConfig& config, double noise = 0.0) {
  return testing::map_of(testing::points_of(wall, 6.0, 2.0, 0.01, noise), config);
}

/// A point of the wall, seen from `pose`, and its residual there.
struct Probe {
  const BumpMap& map;
  Eigen::Vector3d p_body;

  std::optional<Residual> at(const Pose& pose) const {
    return residual(map, pose, pose.R(), p_body, true);
  }
  /// (r(pose + step) - r(pose - step)) / 2; none where another voxel or no surface is met.
  std::optional<double> half_change(const Pose& pose, const Vector6& step) const {
    const Pose ahead = pose * Pose{so3_exp(step.head<3>()), step.tail<3>()};
    const Pose behind = pose * Pose{so3_exp(-step.head<3>()), -step.tail<3>()};
    const BumpVoxel* voxel = map.nearest(pose * p_body);
    if (map.nearest(ahead * p_body) != voxel || map.nearest(behind * p_body) != voxel) return {};
    const auto after = at(ahead);
    const auto before = at(behind);
    if (!after || !before) return {};
    return 0.5 * (after->value - before->value);
  }
};

/// The slope is the difference over two pixels, so a move by a pixel along an axis of the image
/// gives it exactly.
TEST(BievrRegistration, JacobianIsTheChangeOverTwoPixels) {
  const WavyWall wall{.amplitude = 0.004, .wavelength = 0.6};
  const BumpMap map = wall_map(wall, MapConfig());
  const Pose pose{so3_exp({0.02, -0.01, 0.3}), {2.0, -1.0, 1.0}};
  RandomStream random(5, "jacobian");
  int compared = 0;
  for (int i = 0; i < 300; ++i) {
    const Eigen::Vector3d p_world = wall.at(1.0 + 4.0 * random.uniform(), 0.3 + random.uniform());
    const Probe probe{map, pose.inverse() * p_world};
    const auto here = probe.at(pose);
    ASSERT_TRUE(here);
    for (int axis = 0; axis < 2; ++axis) {
      Vector6 step = Vector6::Zero();
      step.tail<3>() = 0.05 * pose.R().transpose() *
                       map.nearest(p_world)->image.R_image_world().row(axis).transpose();
      const auto change = probe.half_change(pose, step);
      if (!change) continue;
      EXPECT_NEAR(*change, here->jacobian.dot(step), 1e-9);
      ++compared;
    }
  }
  EXPECT_GT(compared, 200);
}

TEST(BievrRegistration, JacobianMatchesFiniteDifferences) {
  const WavyWall wall{.amplitude = 0.004, .wavelength = 0.6};
  const BumpMap map = wall_map(wall, MapConfig());
  const Pose pose{so3_exp({0.02, -0.01, 0.3}), {2.0, -1.0, 1.0}};
  // Over less than two pixels the slope is off by the curvature of the wave times a pixel, or by
  // twice that where a pixel at the edge of the voxel has points on one side only.
  const double curvature = wall.amplitude * wall.wave() * wall.wave();
  RandomStream random(6, "jacobian");
  for (int i = 0; i < 300; ++i) {
    const Eigen::Vector3d p_world = wall.at(1.0 + 4.0 * random.uniform(), 0.3 + random.uniform());
    const Probe probe{map, pose.inverse() * p_world};
    const auto here = probe.at(pose);
    ASSERT_TRUE(here);
    for (int k = 0; k < 6; ++k) {
      const double lever = k < 3 ? probe.p_body.norm() : 1.0;
      const double size = 5e-3 / lever;
      const auto change = probe.half_change(pose, size * Vector6::Unit(k));
      if (!change) continue;
      EXPECT_NEAR(*change / size, here->jacobian(k), 2.0 * lever * curvature * 0.05) << k;
    }
  }
}

TEST(BievrRegistration, AShiftAlongAWavyWallIsRecovered) {
  const WavyWall wall{.amplitude = 0.005, .wavelength = 0.5};
  const BumpMap map = wall_map(wall, MapConfig());
  const Pose truth{so3_exp({0.0, 0.0, 0.2}), {2.0, -1.0, 1.0}};
  const auto points = seen(wall, truth);
  for (const double shift : {-0.08, -0.03, 0.03, 0.08}) {
    Pose start = truth;
    start.translation.x() += shift;
    start.translation.y() += 0.01;
    const Registered result = registered(map, start, points, RegistrationConfig());
    EXPECT_TRUE(result.converged) << shift;
    EXPECT_NEAR(result.T_world_body.translation.x(), truth.translation.x(), 2e-3) << shift;
    EXPECT_NEAR(result.T_world_body.translation.y(), truth.translation.y(), 1e-3) << shift;
  }
}

/// Smallest eigenvalue of the information about x, per point.
double information_along(const BumpMap& map, const WavyWall& wall, double noise) {
  const Pose pose{Eigen::Quaterniond::Identity(), {2.0, -1.0, 1.0}};
  const auto points = seen(wall, pose, noise);
  const LinearCost linear = linearize(map, pose, points, RegistrationConfig());
  return linear.hessian(3, 3) / linear.used;
}

TEST(BievrRegistration, AFlatWallHoldsNothingAlongItself) {
  const WavyWall flat{.amplitude = 0.0};
  EXPECT_LT(information_along(wall_map(flat, MapConfig()), flat, 0.0), 1e-8);
  // Noise of the map's points, s = 10 mm over some 25 per pixel, pretends slopes of
  // s / (5 pixels sqrt(2)) before smoothing.
  const double noise = information_along(wall_map(flat, MapConfig(), 0.01), flat, 0.01);
  const double pretended = 0.01 / 5.0 / 0.05 / std::sqrt(2.0);
  EXPECT_LT(noise, pretended * pretended);
  EXPECT_GT(noise, 0.01 * pretended * pretended);
  // A wave of 5 mm over 0.5 m, a mean square slope of (A k)^2 / 2, is above it.
  const WavyWall wall{.amplitude = 0.005, .wavelength = 0.5};
  const double real = information_along(wall_map(wall, MapConfig(), 0.01), wall, 0.01);
  const double slope = wall.amplitude * wall.wave();
  EXPECT_GT(real, 0.3 * 0.5 * slope * slope);
  EXPECT_LT(real, 1.2 * 0.5 * slope * slope + pretended * pretended);
}

TEST(BievrRegistration, WithoutInformationThePoseStaysAtThePrediction) {
  const WavyWall flat{.amplitude = 0.0};
  const BumpMap map = wall_map(flat, MapConfig());
  const Pose truth{Eigen::Quaterniond::Identity(), {2.0, -1.0, 1.0}};
  Pose start = truth;
  start.translation += Eigen::Vector3d(0.05, 0.02, -0.04);
  const Registered result = registered(map, start, seen(flat, truth), RegistrationConfig());
  EXPECT_NEAR(result.T_world_body.translation.y(), truth.translation.y(), 1e-4);
  EXPECT_NEAR(result.T_world_body.translation.x(), start.translation.x(), 1e-3);
  EXPECT_NEAR(result.T_world_body.translation.z(), start.translation.z(), 1e-3);
}

TEST(BievrRegistration, PlanesAloneHoldNothingAlongAWavyWall) {
  const WavyWall wall{.amplitude = 0.002, .wavelength = 0.25};  // averages out in a voxel
  const BumpMap map = wall_map(wall, MapConfig());
  const Pose pose{Eigen::Quaterniond::Identity(), {2.0, -1.0, 1.0}};
  RegistrationConfig planes;
  planes.relief = false;
  const auto points = seen(wall, pose);
  const double flat = linearize(map, pose, points, planes).hessian(3, 3);
  const double relief = linearize(map, pose, points, RegistrationConfig()).hessian(3, 3);
  EXPECT_LT(flat, 0.1 * relief);
}

TEST(BievrSampling, KeepsAllPointsWhereThereIsRelief) {
  // The first half of the wall is wavy, the second flat.
  const WavyWall wavy;
  const WavyWall flat{.amplitude = 0.0};
  const auto wall_at = [&](double x) { return x < 3.0 ? wavy : flat; };
  std::vector<MapPoint> points;
  std::vector<Eigen::Vector3d> scan;
  for (double z = 0.005; z < 2.0; z += 0.01) {
    for (double x = 0.005; x < 6.0; x += 0.01) points.push_back({wall_at(x).at(x, z), 2.0});
  }
  for (double z = 0.05; z < 2.0; z += 0.1) {
    for (double x = 0.05; x < 6.0; x += 0.1) scan.push_back(wall_at(x).at(x, z));
  }
  const BumpMap map = testing::map_of(points, MapConfig());
  // 12 x 4 voxels with 25 points each; 24 of them are wavy.
  const Sample sample = informed_sample(scan, map, Pose(), 24);
  EXPECT_EQ(sample.fine, 600U);
  EXPECT_EQ(sample.points.size(), 600U + 24U);
  for (std::size_t i = 0; i < sample.points.size(); ++i) {
    EXPECT_EQ(sample.points[i].x() < 3.0, i < sample.fine);
  }
  EXPECT_EQ(informed_sample(scan, map, Pose(), scan.size()).points.size(), scan.size());
}

TEST(BievrSampling, ThinningKeepsThePointNearestToEachCentre) {
  const std::vector<Eigen::Vector3d> points = {
      {0.01, 0.01, 0.01}, {0.06, 0.05, 0.05}, {0.09, 0.09, 0.09}, {-0.04, 0.05, 0.05}};
  const auto chosen = thinned(points, 0.1);
  ASSERT_EQ(chosen.size(), 2U);
  EXPECT_TRUE(chosen[0] == points[1] || chosen[1] == points[1]);
  EXPECT_TRUE(chosen[0] == points[3] || chosen[1] == points[3]);
}

}  // namespace
}  // namespace aims::bievr
