// SPDX-License-Identifier: BSD-3-Clause
#include "sim/robot/mounts.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "sim/simulation.hpp"

namespace aims {
namespace {

const Mounts kNominal = {Pose{Eigen::Quaterniond::Identity(), {-0.17, 0.0, 0.02}},
                         Pose{Eigen::Quaterniond::Identity(), {0.03, 0.0, 0.16}}};

bool same(const Pose& a, const Pose& b) {
  return a.translation == b.translation && a.rotation.coeffs() == b.rotation.coeffs();
}

TEST(Calibration, WithoutErrorsTheMountsAreTheNominalOnes) {
  const Mounts mounts = true_mounts(kNominal, {}, 7);
  EXPECT_TRUE(same(mounts.T_base_body, kNominal.T_base_body));
  EXPECT_TRUE(same(mounts.T_body_lidar, kNominal.T_body_lidar));
}

TEST(Calibration, ErrorsHaveTheConfiguredSpreadOverRuns) {
  const CalibrationErrorConfig config = {.rotation_sigma_deg = 0.5, .translation_sigma = 0.004};
  constexpr int kRuns = 2000;
  double turn = 0.0;
  double shift = 0.0;
  double common = 0.0;
  for (int seed = 1; seed <= kRuns; ++seed) {
    const Mounts mounts = true_mounts(kNominal, config, seed);
    const Pose lidar = kNominal.T_body_lidar.inverse() * mounts.T_body_lidar;
    const Pose imu = kNominal.T_base_body.inverse() * mounts.T_base_body;
    turn += so3_log(lidar.rotation).squaredNorm() / (3.0 * kRuns);
    shift += lidar.translation.squaredNorm() / (3.0 * kRuns);
    common += lidar.translation.dot(imu.translation) / (3.0 * kRuns);
  }
  EXPECT_NEAR(std::sqrt(turn) * 180.0 / std::numbers::pi, 0.5, 0.02);
  EXPECT_NEAR(std::sqrt(shift), 0.004, 0.00016);
  EXPECT_NEAR(common, 0.0, 0.05 * 0.004 * 0.004) << "the two mounts are drawn independently";
}

/// A second of standing in a corridor, with errors of calibration.
SimulationConfig standing(double rotation_sigma_deg) {
  SimulationConfig config;
  config.route.points = {{"a", 0.0, 0.0}, {"b", 2.0, 0.0}};
  config.scene.corridor.doors.sides = WallSides::kNone;
  config.lidar.columns = 64;
  config.lidar.range_sigma = 0.0;
  config.calibration = {rotation_sigma_deg, 0.01};
  return config;
}

TEST(Calibration, EstimatorsAreToldTheNominalRigWhateverIsDrawn) {
  const auto without = Simulation::create(standing(0.0), 1);
  ASSERT_TRUE(without);
  for (const std::uint64_t seed : {1, 2, 3}) {
    const auto simulation = Simulation::create(standing(2.0), seed);
    ASSERT_TRUE(simulation);
    const SensorRig& rig = simulation->rig();
    EXPECT_TRUE(same(rig.T_body_lidar, without->rig().T_body_lidar));
    EXPECT_TRUE(same(rig.T_body_base, without->rig().T_body_base));
    EXPECT_EQ(rig.leg_geometry.thigh, without->rig().leg_geometry.thigh);
    EXPECT_EQ(rig.leg_geometry.calf, without->rig().leg_geometry.calf);
    const Mounts mounts =
        true_mounts({rig.T_body_base.inverse(), rig.T_body_lidar}, {2.0, 0.01}, seed);
    EXPECT_TRUE(same(simulation->truth().mounts.T_body_lidar, mounts.T_body_lidar));
    EXPECT_GT((mounts.T_body_lidar.translation - rig.T_body_lidar.translation).norm(), 1e-3);
  }
}

/// Largest distance [m] of the returns of the first scan from the walls y = +-1.1 m of the
/// corridor, seen from that mount. Only returns at mid-height are taken: they are of the side
/// walls.
double largest_wall_residual(const Simulation& simulation, const std::vector<Delivery>& deliveries,
                             const Pose& T_body_lidar) {
  for (const Delivery& delivery : deliveries) {
    const auto* scan = std::get_if<LidarScanPtr>(&delivery.measurement);
    if (scan == nullptr) continue;
    double largest = 0.0;
    const Trajectory truth = body_trajectory(simulation.truth());
    for (const LidarPoint& point : (*scan)->points) {
      const auto T_world_body = pose_at(truth, (*scan)->stamp + point.time_offset_ns);
      const Eigen::Vector3d hit = *T_world_body * (T_body_lidar * point.position.cast<double>());
      if (hit.z() < 0.5 || hit.z() > 1.8 || std::abs(hit.x()) > 2.0) continue;
      largest = std::max(largest, std::abs(std::abs(hit.y()) - 1.1));
    }
    return largest;
  }
  return std::numeric_limits<double>::infinity();
}

TEST(Calibration, TheLidarMeasuresFromItsTrueMount) {
  auto simulation = Simulation::create(standing(2.0), 5);
  ASSERT_TRUE(simulation);
  std::vector<Delivery> deliveries;
  simulation->advance(kSecond, deliveries);
  const double from_true =
      largest_wall_residual(*simulation, deliveries, simulation->truth().mounts.T_body_lidar);
  const double from_nominal =
      largest_wall_residual(*simulation, deliveries, simulation->rig().T_body_lidar);
  EXPECT_LT(from_true, 1e-3);
  EXPECT_GT(from_nominal, 5e-3);
}

}  // namespace
}  // namespace aims
