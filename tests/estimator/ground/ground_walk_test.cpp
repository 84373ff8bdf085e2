// SPDX-License-Identifier: BSD-3-Clause
// The ground constraint along a path over level ground, ramps and steps, in closed form.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "estimator/ground/ground_constraint.hpp"
#include "tests/estimator/ground/ground_scene.hpp"

namespace aims {
namespace {

using E = ErrorState;
using test::belief_at;
using test::kHeight;

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

/// Starts on a slope of 8 % that ends after 5 m. The accelerometer hides all but 50 mrad of it.
Sequence start_on_slope() {
  test::GroundScene scene;
  scene.height = [](double x, double) { return test::ramp_height(x, -5.0, 10.0, 0.08); };
  return Sequence(scene, {0.0, 0.03, 0.0}, 0.025);
}

TEST(GroundConstraint, AStartThatPassedForLevelIsASlopeOnceTheFloorAheadAgreesWithGravity) {
  Sequence sequence = start_on_slope();
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
