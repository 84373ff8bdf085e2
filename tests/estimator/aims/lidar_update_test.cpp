// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/aims/lidar_update.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string_view>
#include <vector>

#include "core/random.hpp"
#include "estimator/aims/presets.hpp"
#include "tests/estimator/aims/corridor_walk.hpp"

namespace aims {
namespace {

using E = ErrorState;
using test::Corridor;
using test::CorridorWalk;
using test::fill;
using test::kHalfWidth;

/// A prediction with an error of 5 cm along every axis, and fully correlated errors of position and
/// leg scale.
Belief correlated_prediction(const Eigen::Vector3d& truth) {
  Belief belief;
  belief.state.position = truth + Eigen::Vector3d::Constant(0.05);
  ErrorVector common = ErrorVector::Zero();
  segment(common, E::kPosition).setConstant(0.1);
  segment(common, E::kLegScale).setConstant(0.1);
  belief.covariance = common * common.transpose() + 1e-4 * ErrorMatrix::Identity();
  return belief;
}

TEST(LidarUpdate, ConsidersTheLegStatesBetweenPlainWallsOnly) {
  EXPECT_TRUE(CorridorWalk(false).update.considers_legs());
  EXPECT_FALSE(CorridorWalk(false, "tfs_plus").update.considers_legs())
      << "without cross-validation";
  EXPECT_FALSE(CorridorWalk(true).update.considers_legs())
      << "pillars constrain the longitudinal direction";
}

TEST(LidarUpdate, KnowsThatAllDirectionsAreConstrainedByCrossValidationOnly) {
  EXPECT_TRUE(CorridorWalk(true).update.constrains_all_directions());
  EXPECT_FALSE(CorridorWalk(false).update.constrains_all_directions());
  EXPECT_FALSE(CorridorWalk(true, "tfs_plus").update.constrains_all_directions());
}

// Also of the scans whose real part is cut along the way, since legs are compared with them.
TEST(LidarUpdate, PlainWallsLeaveTheWayFreeAndPillarsDoNot) {
  for (const bool pillars : {true, false}) {
    const CorridorWalk walk(pillars, "aims_d", 0.0, ScanPart::kAll);
    NominalState ahead;
    EXPECT_EQ(walk.update.constrains_the_way(ahead), pillars);
    ahead.rotation = so3_exp({0.0, 0.0, 1.4});
    EXPECT_TRUE(walk.update.constrains_the_way(ahead)) << "across the corridor";
  }
  EXPECT_FALSE(CorridorWalk(true, "tfs_plus").update.constrains_the_way(NominalState()));
}

// Between pillars a scan corrects the leg scale; while the compliance of the joints is being
// learned it leaves the scale alone.
TEST(LidarUpdate, LegsThatAreHeldKeepTheirScale) {
  for (const bool held : {false, true}) {
    CorridorWalk walk(true);
    const Belief predicted = correlated_prediction(walk.truth);
    walk.update.hold_legs(held);
    const Belief updated = walk.fuse(predicted);
    EXPECT_NEAR(updated.state.position.x(), walk.truth.x(), 0.02);
    EXPECT_EQ((updated.state.leg_scale - predicted.state.leg_scale).norm() < 1e-9, held);
  }
}

TEST(LidarUpdate, PlainWallsCorrectAcrossThemOnly) {
  CorridorWalk walk(false);
  const Belief predicted = correlated_prediction(walk.truth);
  const Belief updated = walk.fuse(predicted);
  EXPECT_LT((updated.state.position - walk.truth).tail<2>().norm(), 0.015);
  EXPECT_NEAR(updated.state.position.x(), predicted.state.position.x(), 0.005);
  EXPECT_LT((updated.state.leg_scale - predicted.state.leg_scale).norm(), 1e-9);
  const int x = E::kPosition.offset;
  EXPECT_GT(updated.covariance(x, x), 0.8 * predicted.covariance(x, x));
}

// Walls that draw nearer by 7.5 mrad show where the robot is. Where noise helps to map, a map shows
// as much by itself.
TEST(LidarUpdate, MoreTiltIsFreeWhileAllInformationIsTaken) {
  constexpr double kTaper = 0.0075;  // [rad]
  EXPECT_FALSE(CorridorWalk(false, "aims_d", kTaper, ScanPart::kReal).update.considers_legs());
  EXPECT_TRUE(CorridorWalk(false, "aims_d", kTaper, ScanPart::kAll).update.considers_legs());
}

// Between plain walls the noise of the map holds a belief where it is predicted to be.
TEST(LidarUpdate, AllInformationContainsThatOfNoise) {
  CorridorWalk walk(false);
  const Belief predicted = correlated_prediction(walk.truth);
  const Belief updated = walk.fuse(predicted, ScanPart::kAll);
  const int x = E::kPosition.offset;
  EXPECT_LT(updated.covariance(x, x), 0.5 * predicted.covariance(x, x));
  EXPECT_GT((updated.state.leg_scale - predicted.state.leg_scale).norm(), 1e-4);
}

// The scan is 20 mrad off, and attitude and mount are as uncertain as each other.
TEST(LidarUpdate, AScanThatTurnsTheMountTooLiesInTheMap) {
  for (const ScanPart part : {ScanPart::kAll, ScanPart::kReal}) {
    CorridorWalk walk(true);
    Belief predicted;
    predicted.state.position = walk.truth;
    predicted.state.rotation = so3_exp({0.0, 0.0, 0.02});
    predicted.covariance = 1e-6 * ErrorMatrix::Identity();
    block(predicted.covariance, E::kRotation, E::kRotation) = 9e-4 * Eigen::Matrix3d::Identity();
    block(predicted.covariance, E::kMount, E::kMount) = 9e-4 * Eigen::Matrix3d::Identity();
    const NominalState updated = walk.fuse(predicted, part).state;
    EXPECT_NEAR(so3_log(updated.rotation).z(), 0.01, 1e-3);
    EXPECT_NEAR(so3_log(updated.mount).z(), -0.01, 1e-3);
    EXPECT_LT(so3_log(scan_pose(updated, CalibrationModel()).rotation).norm(), 1e-3);
  }
}

// The estimate may be far from the belief that maps: between plain walls that changes nothing of
// what the real part of a scan does to it; between pillars the scan takes it to the other one.
TEST(LidarUpdate, TheRealPartActsWhereTheScanWasMatched) {
  for (const bool pillars : {false, true}) {
    CorridorWalk walk(pillars);
    Belief predicted = correlated_prediction(walk.truth);
    block(predicted.covariance, E::kPosition, E::kPosition) += 4.0 * Eigen::Matrix3d::Identity();
    (void)walk.fuse(predicted, ScanPart::kAll);
    predicted.state.position.x() += 2.0;
    const Belief updated = walk.update.update_with_real_part(predicted, walk.map);
    EXPECT_LT((updated.state.position - walk.truth).tail<2>().norm(), 0.02);
    const double x = updated.state.position.x() - walk.truth.x();
    EXPECT_NEAR(x, pillars ? 0.0 : 2.05, 0.03);
  }
}

// A leg sample whose model of the scale is off by a percent, after a distance over which the
// scale has made the position uncertain by metres: the gain along x is 0.1 m per m/s then, and 200
// samples a second would carry the position away. What position and velocity have in common
// besides, of the last moments, does correct it.
TEST(LidarUpdate, BetweenPlainWallsLegsCorrectThePositionAsIfTheirScaleWereKnown) {
  const CorridorWalk walk(false);
  Belief belief;
  ErrorVector common = ErrorVector::Zero();
  common(E::kPosition.offset) = -3.0;
  common(E::kVelocity.offset) = -0.09;
  common(E::kLegScale.offset) = 0.12;
  belief.covariance = common * common.transpose() + 1e-4 * ErrorMatrix::Identity();
  belief.covariance.diagonal().segment<E::kLegSize>(E::kLegScale.offset).array() += 1e-8 - 1e-4;
  LinearMeasurement legs;
  legs.residual = Eigen::Vector3d(0.05, 0.05, 0.0);
  columns(legs.jacobian, E::kVelocity).setIdentity();
  columns(legs.jacobian, E::kLegScale) = Eigen::Vector3d(0.73, 0.0, 0.0).asDiagonal();
  legs.noise = 0.01 * Eigen::Matrix3d::Identity();
  const double plain = fuse(belief, legs).state.position.x();
  EXPECT_GT(std::abs(plain), 0.005) << "the scale has something to do";
  const Belief updated = walk.update.fuse_velocity(belief, legs);
  EXPECT_LT(std::abs(updated.state.position.x()), 1e-3);
  EXPECT_LT(updated.state.leg_scale.norm(), 1e-12);
  EXPECT_NE(updated.state.velocity.y(), 0.0);

  const double recent = 5e-5;
  belief.covariance(E::kPosition.offset, E::kVelocity.offset) += recent;
  belief.covariance(E::kVelocity.offset, E::kPosition.offset) += recent;
  const double moved = walk.update.fuse_velocity(belief, legs).state.position.x();
  EXPECT_NEAR(moved - updated.state.position.x(), -recent * 0.05 / 0.0101, 5e-6);

  const CorridorWalk constrained(true);
  for (const GainMask& mask : {GainMask(), GainMask{.legs = false}}) {
    EXPECT_EQ(constrained.update.fuse_velocity(belief, legs, mask).covariance,
              fuse(belief, legs, mask).covariance)
        << "pillars constrain x";
  }
}

TEST(LidarUpdate, JudgesThePredictionOfTheImuByWhatTheScanMakesOfIt) {
  CorridorWalk walk(true, "aims");
  Belief predicted;
  predicted.state.position = walk.truth;
  predicted.covariance = 1e-4 * ErrorMatrix::Identity();
  Belief leg_free = predicted;
  leg_free.state.position.y() += 0.05;
  leg_free.covariance *= 2.0;
  (void)walk.fuse(predicted, ScanPart::kReal, &leg_free);
  const ScanDiagnostics with_both = walk.diagnostics;
  EXPECT_EQ(with_both.C_IL, with_both.C_IL_imu) << "the paper's reading is the default";
  EXPECT_GT(with_both.C_IL_imu, 3.0 * with_both.C_IL_imu_legs);

  // The same scan as if the filter itself had predicted so.
  CorridorWalk same(true, "aims");
  (void)same.fuse(leg_free);
  EXPECT_NEAR(with_both.C_IL_imu, same.diagnostics.C_IL_imu_legs,
              0.02 * same.diagnostics.C_IL_imu_legs);
  EXPECT_TRUE(std::isnan(same.diagnostics.C_IL_imu)) << "without that prediction";
  EXPECT_EQ(same.diagnostics.C_IL, same.diagnostics.C_IL_imu_legs) << "what there is";
}

TEST(LidarUpdate, PillarsCorrectTheLongitudinalDirectionAndTheLegs) {
  CorridorWalk walk(true);
  const Belief predicted = correlated_prediction(walk.truth);
  const Belief updated = walk.fuse(predicted);
  EXPECT_LT((updated.state.position - walk.truth).norm(), 0.02);
  EXPECT_GT((updated.state.leg_scale - predicted.state.leg_scale).norm(), 0.03);
}

// After seconds without scans the attitude is far off. A step there fits the planes that happen to
// lie where the prediction puts the points.
TEST(LidarUpdate, FindsBackFromAPredictionThatIsFarOff) {
  for (const std::string_view preset : {"aims_d", "lio"}) {
    CorridorWalk walk(true, preset);
    const int usual = walk.diagnostics.points_used;
    Belief predicted;
    predicted.state.position = walk.truth + Eigen::Vector3d(0.1, 0.1, -0.1);
    predicted.state.rotation = so3_exp({-0.05, 0.3, -0.05});
    predicted.covariance = 1e-6 * ErrorMatrix::Identity();
    block(predicted.covariance, E::kRotation, E::kRotation) = 9e-4 * Eigen::Matrix3d::Identity();
    block(predicted.covariance, E::kPosition, E::kPosition) = 0.01 * Eigen::Matrix3d::Identity();
    const Belief updated = walk.fuse(predicted);
    EXPECT_LT(so3_log(updated.state.rotation).norm(), 0.003) << preset;
    EXPECT_LT((updated.state.position - walk.truth).norm(), 0.005) << preset;
    EXPECT_GT(walk.diagnostics.points_used, 0.9 * usual) << preset;
    EXPECT_GT(walk.diagnostics.iterations, eskf_preset(preset).lidar.max_iterations);
  }
}

/// Returns near one wall of a plain corridor: seven of nine 0.196 m outside it, two as far inside.
/// Millimetres towards the seven, and the residual gate takes those two away.
std::vector<Eigen::Vector3f> returns_about_a_wall(int count) {
  std::vector<Eigen::Vector3f> scan;
  for (int i = 0; i < count; ++i) {
    const float offset = 7 * i % 9 < 7 ? 0.196F : -0.196F;
    scan.emplace_back(-2.0F + 0.4F * static_cast<float>(i % 10),
                      static_cast<float>(kHalfWidth) + offset,
                      -0.8F + 0.2F * static_cast<float>(i / 10));
  }
  return scan;
}

TEST(LidarUpdate, IsRefusedWhenItsLastLinearizationHasTooFewPlanes) {
  RandomStream random(1, "last_linearization");
  Corridor corridor(0.0, random);
  VoxelMap map(MapConfig{});
  fill(map, corridor, -5.0, 5.0);
  Belief predicted;
  predicted.covariance = 1e-6 * ErrorMatrix::Identity();
  block(predicted.covariance, E::kPosition, E::kPosition) = 2e-5 * Eigen::Matrix3d::Identity();
  const auto update = [&](int count) {
    EskfConfig config = eskf_preset("tfs_clean");
    config.lidar.max_iterations = 1;
    ScanDiagnostics diagnostics;
    const Belief belief = LidarUpdate(config).update(predicted, returns_about_a_wall(count), map,
                                                     {}, ScanPart::kReal, diagnostics);
    EXPECT_EQ(boxminus(belief.state, predicted.state).isZero(0.0), diagnostics.iterations == 0);
    return diagnostics;
  };
  const ScanDiagnostics fused = update(80);
  EXPECT_EQ(fused.iterations, 2);
  ASSERT_GE(fused.points_used, 40);
  ASSERT_LE(fused.points_used, 70) << "the gate took returns away";
  const ScanDiagnostics refused = update(36);
  EXPECT_LT(refused.points_used, kMinMatches) << "the gate left 28 of 36";
  EXPECT_EQ(refused.iterations, 0);
}

/// One scan against a noisy map of a corridor with shallow faces, from a prediction whose error
/// along the corridor is drawn from its covariance; squared error after the update over its stated
/// variance. Every point has an error of its own.
double normalised_error_along(double facing, std::uint64_t seed) {
  RandomStream random(seed, "wall_and_recess");
  Corridor corridor(facing, random);
  EskfConfig config = eskf_preset("aims_d");
  config.robust_kernel.enabled = false;
  config.lidar.correlated_points = 1.0;
  VoxelMap map(MapConfig{});
  fill(map, corridor, -3.0, 3.0);
  LidarUpdate update(config);
  const auto fuse = [&](const Eigen::Vector3d& truth, const Belief& predicted) {
    std::vector<Eigen::Vector3f> scan;
    for (int i = 0; i < 300; ++i) {
      scan.push_back((corridor.point(-2.8, 2.8) - truth).cast<float>());
    }
    ScanDiagnostics diagnostics;
    return update.update(predicted, scan, map, {}, ScanPart::kReal, diagnostics);
  };
  Belief belief;
  belief.covariance = 1e-6 * ErrorMatrix::Identity();
  for (double x = -2.5; x < -0.03; x += 0.05) {  // learns the noise
    belief.state.position.x() = x;
    (void)fuse(belief.state.position, belief);
  }
  constexpr double kSigma = 0.01;  // of the prediction along the corridor [m]
  const int x = E::kPosition.offset;
  belief.state.position.setZero();
  belief.covariance(x, x) = kSigma * kSigma;
  const Eigen::Vector3d truth(kSigma * random.normal(), 0.0, 0.0);
  const Belief updated = fuse(truth, belief);
  const double error = updated.state.position.x() - truth.x();
  return error * error / stated_covariance(updated)(x, x);
}

TEST(LidarUpdate, TheStatedVarianceIsTheRealOneBetweenWallsWithFaces) {
  constexpr int kDraws = 100;
  for (const double facing : {0.0, 0.01, 0.03}) {
    double sum = 0.0;
    for (int draw = 0; draw < kDraws; ++draw) {
      sum += normalised_error_along(facing, static_cast<std::uint64_t>(1000 + draw));
    }
    // 100 draws: 99.9 % of chi-square lies within 0.60 and 1.50.
    EXPECT_GT(sum / kDraws, 0.60) << "faces " << facing << ", seeds 1000 to 1099";
    EXPECT_LT(sum / kDraws, 1.50) << "faces " << facing << ", seeds 1000 to 1099";
  }
}

}  // namespace
}  // namespace aims
