// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/ground/ground_constraint.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "estimator/filter/static_initialization.hpp"
#include "tests/estimator/ground/ground_scene.hpp"

namespace aims {
namespace {

using E = ErrorState;

constexpr double kHeight = 0.32;
constexpr double kGravity = 9.81;

GroundPlane plane_at(const Pose& T_world_body, double ground_z = 0.0) {
  GroundPlane plane;
  plane.normal = T_world_body.rotation.conjugate() * Eigen::Vector3d::UnitZ();
  plane.height = T_world_body.translation.z() - ground_z;
  plane.points = 300;
  return plane;
}

/// A belief at the pose with the deviations of a standing start.
Belief belief_at(const Pose& pose, double sigma_tilt = 5e-3, double sigma_z = 1e-4) {
  Belief belief;
  belief.state.rotation = pose.rotation;
  belief.state.position = pose.translation;
  belief.covariance = ErrorMatrix::Identity() * 1e-4;
  block(belief.covariance, E::kRotation, E::kRotation) =
      Eigen::Matrix3d::Identity() * sigma_tilt * sigma_tilt;
  block(belief.covariance, E::kPosition, E::kPosition) =
      Eigen::Matrix3d::Identity() * sigma_z * sigma_z;
  block(belief.covariance, E::kAccelerometerBias, E::kAccelerometerBias) =
      Eigen::Matrix3d::Identity() * 0.05 * 0.05;
  return belief;
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

/// Moves along x over `scene`; the filter predicts the true motion, in its own tilted frame, with
/// growing covariance.
struct Sequence {
  explicit Sequence(const test::GroundScene& over,
                    const Eigen::Vector3d& tilt = Eigen::Vector3d::Zero(), double sigma_tilt = 1e-3)
      : scene(over) {
    truth.translation.z() = scene.height(0.0, 0.0) + kHeight;
    truth.rotation = attitude_on_ground(0.0);
    belief = belief_at({truth.rotation * so3_exp(tilt), truth.translation}, sigma_tilt);
    first = belief;
  }

  void step(double dx) {
    const double x = truth.translation.x() + dx;
    const Pose next{attitude_on_ground(x), {x, 0.0, scene.height(x, 0.0) + kHeight}};
    const Eigen::Quaterniond frame = belief.state.rotation * truth.rotation.conjugate();
    belief.state.rotation = belief.state.rotation * (truth.rotation.conjugate() * next.rotation);
    belief.state.position += frame * (next.translation - truth.translation);
    truth = next;
    block(belief.covariance, E::kRotation, E::kRotation) += Eigen::Matrix3d::Identity() * 1e-7;
    block(belief.covariance, E::kPosition, E::kPosition) += Eigen::Matrix3d::Identity() * 1e-6;
    GroundLists lists;
    auto plane = fit_ground(test::scan_ground(scene, truth, random), lists);
    if (plane) {
      const Eigen::Vector3d error(random.normal(), random.normal(), 0.0);
      plane->normal = so3_exp(scan_noise * error) * plane->normal;
    }
    if (const auto m = constraint.measure(belief, plane)) {
      fuse_level(*m);
      constraint.corrected(belief.state, constraint.start_was_sloped());
    }
    ++scans;
    level += static_cast<int>(constraint.status() == GroundStatus::kLevel);
    worst_z = std::max(worst_z, std::abs(z_error()));
    worst_tilt = std::max(worst_tilt, tilt_error());
  }

  void fuse_level(const LinearMeasurement& m) {
    if (!constraint.start_was_sloped()) {
      belief = fuse_ground(belief, m);
      return;
    }
    revised_at = truth.translation.x();
    belief =
        with_turned_path(fuse_ground(with_tilt_of(belief, first), m), belief.state, first.state);
  }

  Eigen::Quaterniond attitude_on_ground(double x) const {
    const double slope = (scene.height(x + 0.2, 0.0) - scene.height(x - 0.2, 0.0)) / 0.4;
    return so3_exp({0.0, -std::atan(slope), 0.0});
  }

  void walk_to(double x) {
    const double dx = x > truth.translation.x() ? 0.1 : -0.1;
    while ((x - truth.translation.x()) / dx > 0.5) step(dx);
  }

  double z_error() const { return belief.state.position.z() - truth.translation.z(); }
  double tilt_error() const {
    return so3_log(truth.rotation.conjugate() * belief.state.rotation).head<2>().norm();
  }

  test::GroundScene scene;
  Pose truth;
  Belief belief;
  Belief first;
  GroundConstraint constraint{GroundConstraintConfig{}};
  RandomStream random{1, "floor_walk"};
  double scan_noise = 0.0;  ///< of the normal of one scan, which its covariance leaves out [rad]
  std::optional<double> revised_at;  ///< where the start was found to be a slope [m]
  int scans = 0;
  int level = 0;
  double worst_z = 0.0;
  double worst_tilt = 0.0;
};

test::GroundScene ramp(double grade) {
  test::GroundScene scene;
  scene.height = [grade](double x, double) { return test::ramp_height(x, 8.0, 6.0, grade); };
  return scene;
}

/// A ramp keeps its slope and its climb up to `max_z` [m], and the first level is found again on
/// the way back.
void expect_ramp_kept(double grade, double scan_noise, double max_z) {
  Sequence sequence(ramp(grade));
  sequence.scan_noise = scan_noise;
  sequence.walk_to(20.0);
  EXPECT_LT(sequence.worst_z, max_z) << grade;
  EXPECT_LT(sequence.worst_tilt, 6e-3) << grade;
  EXPECT_EQ(sequence.constraint.levels(), 2) << grade;
  EXPECT_EQ(sequence.constraint.status(), GroundStatus::kLevel) << grade;
  EXPECT_LT(sequence.level, sequence.scans - 20) << grade << ": the ramp is not level";
  sequence.walk_to(0.0);
  EXPECT_EQ(sequence.constraint.levels(), 2) << grade << ": the first level is found again";
  EXPECT_LT(std::abs(sequence.z_error()), 0.02) << grade;
}

TEST(GroundConstraint, ARampOfTwoPercentKeepsItsSlopeAndItsClimb) {
  expect_ramp_kept(0.02, 0.0, 0.06);
}

TEST(GroundConstraint, ARampOfFivePercentKeepsItsSlopeAndItsClimb) {
  expect_ramp_kept(0.05, 0.0, 0.03);
}

TEST(GroundConstraint, ARampIsKeptWithNoisyScans) { expect_ramp_kept(0.05, 4e-3, 0.04); }

/// Starts on a slope of 8 % that ends after 5 m. The accelerometer hides all but `seen` of it
/// [rad].
Sequence start_on_slope(double seen) {
  test::GroundScene scene;
  scene.height = [](double x, double) { return test::ramp_height(x, -5.0, 10.0, 0.08); };
  return Sequence(scene, {0.0, 0.08 - seen, 0.0}, 0.025);
}

TEST(GroundConstraint, AStartThatPassedForLevelIsASlopeOnceTheFloorAheadAgreesWithGravity) {
  Sequence sequence = start_on_slope(0.05);
  sequence.walk_to(2.0);
  EXPECT_GT(sequence.level, 10) << "the slope passes for level";
  EXPECT_GT(sequence.tilt_error(), 0.07) << "and tilts the frame";
  EXPECT_FALSE(sequence.revised_at.has_value());
  sequence.walk_to(15.0);
  ASSERT_TRUE(sequence.revised_at.has_value());
  EXPECT_LT(*sequence.revised_at, 8.0);
  EXPECT_LT(sequence.tilt_error(), 4e-3);
  EXPECT_LT(std::abs(sequence.z_error()), 0.08) << "of a climb of 0.4 m";
  EXPECT_EQ(sequence.constraint.levels(), 1);
}

/// Whether a level start, tilted by `error` [rad], counts as sloped on the way over a ramp.
bool revises_level_start(double grade, double error) {
  Sequence sequence(ramp(grade), {0.0, error, 0.0}, 0.025);
  sequence.walk_to(20.0);
  return sequence.revised_at.has_value();
}

TEST(GroundConstraint, ALevelStartStaysLevelBeforeSlopes) {
  for (const double grade : {-0.08, -0.05, -0.03, 0.03, 0.05, 0.08}) {
    EXPECT_FALSE(revises_level_start(grade, std::copysign(0.02, grade))) << grade;
  }
  // A slope of 4 % at the start, if it was one, makes one of 8 % no likelier.
  EXPECT_FALSE(revises_level_start(0.08, 0.04));
}

TEST(GroundConstraint, LevelGroundKeepsTiltAndHeightAgainstDrift) {
  Sequence sequence({}, {0.002, -0.003, 0.0});
  while (sequence.truth.translation.x() < 15.0) {
    sequence.step(0.25);
    sequence.belief.state.position.z() += 1e-3;  // drift of a climbing map
  }
  EXPECT_LT(std::abs(sequence.z_error()), 0.02);
  EXPECT_LT(sequence.tilt_error(), 1e-3);
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

TEST(GroundConstraint, LevelGroundRemovesATiltErrorOfThreeDegrees) {
  Sequence sequence({}, {0.03, -0.04, 0.0}, 0.05);
  sequence.walk_to(15.0);
  EXPECT_LT(sequence.worst_z, 0.01);
  EXPECT_LT(sequence.tilt_error(), 2e-3);
  EXPECT_EQ(sequence.level, sequence.scans);
}

TEST(GroundConstraint, NoiseOfTheScansBeyondTheirCovarianceIsNoSlope) {
  Sequence sequence({});
  sequence.scan_noise = 8e-3;  // a 50 Hz IMU on a vibrating trunk
  sequence.walk_to(15.0);
  EXPECT_GT(sequence.level, 0.95 * sequence.scans);
  EXPECT_EQ(sequence.constraint.levels(), 1);
  EXPECT_LT(sequence.worst_z, 0.02);
  EXPECT_LT(sequence.worst_tilt, 5e-3);
}

TEST(GroundConstraint, AThresholdOfThreeCentimetresChangesNothing) {
  test::GroundScene scene;
  scene.height = [](double x, double) { return x > 6.0 && x < 6.15 ? 0.03 : 0.0; };
  Sequence sequence(scene);
  sequence.walk_to(12.0);
  EXPECT_EQ(sequence.constraint.levels(), 1);
  EXPECT_LT(std::abs(sequence.z_error()), 0.01);
  EXPECT_LT(sequence.tilt_error(), 2e-3);
}

TEST(GroundConstraint, AStepLeadsToAnotherLevelAndBack) {
  test::GroundScene scene;
  scene.height = [](double x, double) { return x > 6.0 ? 0.15 : 0.0; };
  Sequence sequence(scene);
  sequence.walk_to(12.0);
  EXPECT_EQ(sequence.constraint.levels(), 2);
  EXPECT_LT(std::abs(sequence.z_error()), 0.02);
  sequence.walk_to(0.0);
  EXPECT_EQ(sequence.constraint.levels(), 2);
  EXPECT_LT(std::abs(sequence.z_error()), 0.02);
}

}  // namespace
}  // namespace aims
