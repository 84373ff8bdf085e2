// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/ground/ground_constraint.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "estimator/filter/static_initialization.hpp"
#include "tests/estimator/ground/ground_scene.hpp"

namespace aims {
namespace {

using E = ErrorState;
using test::belief_at;
using test::kHeight;

constexpr double kGravity = 9.81;

GroundPlane plane_at(const Pose& T_world_body, double ground_z = 0.0) {
  GroundPlane plane;
  plane.normal = T_world_body.rotation.conjugate() * Eigen::Vector3d::UnitZ();
  plane.height = T_world_body.translation.z() - ground_z;
  plane.points = 300;
  return plane;
}

TEST(GroundConstraint, JacobianMatchesFiniteDifferences) {
  const Pose truth{so3_exp({0.01, -0.02, 0.7}), {1.0, 2.0, kHeight}};
  const GroundPlane plane = plane_at(truth);
  Belief belief = belief_at({truth.rotation * so3_exp({0.003, 0.002, 0.0}), truth.translation});
  const auto residual_of = [&plane](const Belief& at) {
    GroundConstraint fresh{GroundConstraintConfig{}};
    Belief start = at;
    start.state.position.z() = kHeight;  // the reference
    (void)fresh.measure(start, plane);
    Belief later = at;
    later.state.position.x() += 1.0;
    return fresh.measure(later, plane).value();
  };
  const LinearMeasurement m = residual_of(belief);
  for (int i = 0; i < E::kPoseSize; ++i) {
    constexpr double kStep = 1e-6;
    ErrorVector delta = ErrorVector::Zero();
    delta(i) = kStep;
    Belief moved = belief;
    moved.state = boxplus(belief.state, delta);
    const Eigen::Vector3d slope = (residual_of(moved).residual - m.residual) / kStep;
    // The height's row leaves out what a tilt of a few milliradians does to it.
    EXPECT_LT((slope.head<2>() - m.jacobian.col(i).head<2>()).norm(), 1e-5) << i;
    if (i >= 3) {
      EXPECT_NEAR(slope.z(), m.jacobian(2, i), 1e-6) << i;
    }
  }
}

/// The belief of a standing start whose mean specific force gives the attitude of `pose` (yaw 0).
Belief start_from(const Pose& pose) {
  std::vector<ImuSample> samples;
  for (int i = 0; i < 110; ++i) {
    samples.push_back({(i + 1) * 20 * kMillisecond, Eigen::Vector3d::Zero(),
                       pose.rotation.conjugate() * Eigen::Vector3d(0.0, 0.0, kGravity)});
  }
  Belief belief = initialize(samples, InitializationConfig{}, kGravity)->belief;
  belief.state.position = pose.translation;
  return belief;
}

TEST(GroundConstraint, TheFirstScanEstimatesTiltAndAccelerometerBias) {
  const double error = 3e-3;
  const Pose truth{so3_exp({0.0, 0.016, 0.0}), {0.0, 0.0, kHeight}};
  const Belief start = start_from({truth.rotation * so3_exp({0.0, error, 0.0}), truth.translation});
  GroundConstraint constraint{GroundConstraintConfig{}};
  const auto measurement = constraint.measure(start, plane_at(truth));
  ASSERT_TRUE(measurement.has_value());
  EXPECT_EQ(constraint.status(), GroundStatus::kLevel);
  const Belief found = fuse_ground(start, *measurement);
  EXPECT_LT(so3_log(truth.rotation.conjugate() * found.state.rotation).head<2>().norm(), 5e-4);
  // The mean force that was turned upward: R_hat^T g up = R^T g up + b.
  const Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
  const Eigen::Vector3d bias =
      kGravity * (start.state.rotation.conjugate() * up - truth.rotation.conjugate() * up);
  EXPECT_LT((found.state.accelerometer_bias - bias).norm(), 0.1 * bias.norm());
}

// Scans made the attitude certain in a map that is tilted as the start.
TEST(GroundConstraint, TheTiltOfTheStartIsFoundAfterTheMapHidIt) {
  const double error = 0.025;
  const Pose truth{so3_exp({0.0, 0.016, 0.4}), {0.0, 0.0, kHeight}};
  const Belief start = start_from({so3_exp({0.0, error, 0.0}), truth.translation});
  Belief later = belief_at({so3_exp({0.0, 0.016 + error, 0.4}), truth.translation}, 1e-3);
  later.state.accelerometer_bias = start.state.accelerometer_bias;
  block(later.covariance, E::kAccelerometerBias, E::kAccelerometerBias) =
      1e-4 * Eigen::Matrix3d::Identity();
  GroundConstraint alone{GroundConstraintConfig{}};
  EXPECT_FALSE(alone.measure(later, plane_at(truth)).has_value());
  const Belief widened = with_tilt_of(later, start);
  GroundConstraint constraint{GroundConstraintConfig{}};
  const auto measurement = constraint.measure(widened, plane_at(truth));
  ASSERT_TRUE(measurement.has_value());
  const Belief found = fuse_ground(widened, *measurement);
  EXPECT_LT(so3_log(truth.rotation.conjugate() * found.state.rotation).head<2>().norm(), 2e-3);
  EXPECT_NEAR(found.state.accelerometer_bias.norm(), kGravity * error, 0.03);
}

TEST(GroundConstraint, AStartOnASlopeUsesGravityUnlessGravityIsUncertain) {
  const Pose on_slope{so3_exp({0.0, -0.06, 0.0}), {0.0, 0.0, kHeight}};
  GroundPlane plane_along_body;
  plane_along_body.height = kHeight;
  GroundConstraint certain{GroundConstraintConfig{}};
  EXPECT_FALSE(certain.measure(belief_at(on_slope), plane_along_body).has_value());
  EXPECT_EQ(certain.status(), GroundStatus::kSloped);
  EXPECT_LT(certain.level_probability(), 1e-3);
  GroundConstraint uncertain{GroundConstraintConfig{}};
  EXPECT_TRUE(uncertain.measure(belief_at(on_slope, 0.05), plane_along_body).has_value());
  EXPECT_GT(uncertain.level_probability(), 0.5);
}

/// Probability that the ground of the first scan is level, after a start whose gravity is known to
/// 25 mrad, on a slope of `pitch` [rad].
double probability_of_level_start(double pitch) {
  GroundPlane plane_along_body;
  plane_along_body.height = kHeight;
  GroundConstraint constraint{GroundConstraintConfig{}};
  const Pose pose{so3_exp({0.0, -pitch, 0.0}), {0.0, 0.0, kHeight}};
  (void)constraint.measure(belief_at(pose, 0.0255), plane_along_body);
  return constraint.level_probability();
}

TEST(GroundConstraint, AStartInTheMiddleOfASlopeNeedsNoBendInView) {
  EXPECT_GT(probability_of_level_start(0.0), 0.9);
  EXPECT_GT(probability_of_level_start(0.02), 0.85);
  EXPECT_LT(probability_of_level_start(0.08), 0.3);
}

TEST(GroundConstraint, IsUsedOnceWhileTheRobotStands) {
  const Pose pose{Eigen::Quaterniond::Identity(), {0.0, 0.0, kHeight}};
  GroundConstraint constraint{GroundConstraintConfig{}};
  int used = 0;
  for (int i = 0; i < 50; ++i) {
    used += static_cast<int>(constraint.measure(belief_at(pose), plane_at(pose)).has_value());
  }
  EXPECT_EQ(used, 1);
}

TEST(GroundConstraint, TenShortStepsGiveAsMuchTiltInformationAsOneLong) {
  const auto information = [](int steps) {
    GroundConstraint constraint{GroundConstraintConfig{}};
    Pose pose{Eigen::Quaterniond::Identity(), {0.0, 0.0, kHeight}};
    (void)constraint.measure(belief_at(pose), plane_at(pose));
    double sum = 0.0;
    for (int i = 0; i < steps; ++i) {
      pose.translation.x() += 0.7 / steps;
      const auto m = constraint.measure(belief_at(pose), plane_at(pose));
      sum += 1.0 / m.value().noise(1, 1);
    }
    return sum;
  };
  EXPECT_NEAR(information(10) / information(1), 1.0, 0.01);
}

TEST(GroundConstraint, HeightDoesNotMoveThePoseAlongAnAlmostHorizontalUnobservableAxis) {
  const Pose pose{Eigen::Quaterniond::Identity(), {0.0, 0.0, kHeight}};
  GroundConstraint constraint{GroundConstraintConfig{}};
  (void)constraint.measure(belief_at(pose), plane_at(pose));
  Belief belief = belief_at({pose.rotation, {1.0, 0.0, kHeight + 0.01}}, 1e-3, 1e-3);
  const Eigen::Vector3d unobservable(1.0, 0.0, 5e-3);
  block(belief.covariance, E::kPosition, E::kPosition) +=
      0.25 * 0.25 * unobservable * unobservable.transpose();
  const Pose truth{pose.rotation, {1.0, 0.0, kHeight}};
  const auto measurement = constraint.measure(belief, plane_at(truth));
  ASSERT_TRUE(measurement.has_value());
  const Belief fused = fuse_ground(belief, *measurement);
  EXPECT_EQ(fused.state.position.x(), belief.state.position.x());
  EXPECT_LT(fused.state.position.z(), belief.state.position.z());
  EXPECT_NEAR(fused.covariance(3, 3), belief.covariance(3, 3), 1e-12);
  EXPECT_LT(fused.covariance(5, 5), belief.covariance(5, 5));
}

TEST(GroundConstraint, EqualsTheKalmanUpdateWithoutAnUnobservableAxis) {
  // Without an unobservable axis the consider states need no correction.
  const Pose truth{so3_exp({0.0, 0.016, 0.0}), {0.0, 0.0, kHeight}};
  const Belief start = start_from({truth.rotation * so3_exp({1e-3, 2e-3, 0.0}), truth.translation});
  GroundConstraint constraint{GroundConstraintConfig{}};
  const LinearMeasurement m = constraint.measure(start, plane_at(truth)).value();
  const Belief constrained = fuse_ground(start, m);
  const Belief full = fuse(start, m);
  EXPECT_LT(boxminus(constrained.state, full.state).norm(), 1e-8);
  EXPECT_LT((constrained.covariance - full.covariance).norm(), 1e-8);
}

/// Height error [m] after 60 m over level ground in a map that bends upward by 0.1 mrad/m. Scans
/// locate the body in the map to 0.4 mrad and 1 mm, and the map follows the body within 3 m.
double height_error_in_a_bent_map(const Eigen::Matrix3d& map_covariance) {
  constexpr double kStep = 0.07;
  constexpr double kMemory = 3.0;
  GroundConstraint constraint{GroundConstraintConfig{}};
  double map_climb = 0.0;  // slope of what the map takes for level [rad]
  double map_z = 0.0;
  double z_error = 0.0;
  for (double x = 0.0; x < 60.0; x += kStep) {
    const Pose truth{Eigen::Quaterniond::Identity(), {x, 0.0, kHeight}};
    const Pose located{so3_exp({0.0, -map_climb, 0.0}), {x, 0.0, kHeight + map_z}};
    Belief belief = belief_at(located, 4e-4, 1e-3);
    const Belief widened = with_map_error(belief, map_covariance);
    if (const auto m = constraint.measure(widened, plane_at(truth))) {
      belief = fuse_ground(widened, *m);
      constraint.corrected(belief.state);
    }
    const double climb = -so3_log(belief.state.rotation).y();
    z_error = belief.state.position.z() - kHeight;
    map_z += climb * kStep + (z_error - map_z) * kStep / kMemory;
    map_climb += 1e-4 * kStep + (climb - map_climb) * kStep / kMemory;
  }
  return z_error;
}

TEST(GroundConstraint, OutweighsABentMapByTheErrorOfTheMap) {
  const Eigen::Matrix3d map_covariance = Eigen::Vector3d::Constant(5e-3 * 5e-3).asDiagonal();
  const double bent = height_error_in_a_bent_map(Eigen::Matrix3d::Zero());
  EXPECT_GT(bent, 0.05);
  EXPECT_LT(std::abs(height_error_in_a_bent_map(map_covariance)), 0.25 * bent);
}

}  // namespace
}  // namespace aims
