// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>

#include "core/random.hpp"
#include "estimator/filter/imu_propagation.hpp"
#include "estimator/legs/leg_velocity_model.hpp"
#include "estimator/lidar/plane_model.hpp"
#include "estimator/lidar/sensor_calibration.hpp"
#include "tests/estimator/finite_differences.hpp"

namespace aims {
namespace {

constexpr double kStep = 0.02;        // [s]
constexpr double kPlaneSigma = 0.02;  // [m]
const ImuNoiseDensity kWhite{2e-3, 5e-2};
const Pose kBase{Eigen::Quaterniond::Identity(), {0.1, 0.0, 0.05}};
const Pose kMount{so3_exp({0.0, 0.3, 0.1}), {0.2, 0.0, 0.15}};

ErrorVector normal_error(RandomStream& random) {
  ErrorVector v;
  for (double& entry : v) entry = random.normal();
  return v;
}

Belief after_legs(const Belief& belief, const NominalState& truth, const Eigen::Vector3d& gyro,
                  RandomStream& random) {
  const Eigen::Vector3d mean(0.6, 0.1, -0.2);
  const Eigen::Matrix3d noise = 0.01 * Eigen::Matrix3d::Identity();
  const LinearMeasurement exact = leg_velocity_model(
      truth, kBase, gyro, LegVelocity{Eigen::Vector3d::Zero(), mean, mean}, noise);
  const Eigen::Vector3d reported = exact.residual + 0.1 * random.normal3();
  return fuse(belief, leg_velocity_model(belief.state, kBase, gyro, {reported, mean, mean}, noise));
}

NominalState moved_on(const NominalState& state, double seconds, const MeanTwist& twist) {
  return after_delay_change(Belief{state}, seconds, twist).state;
}

/// Thirty returns of exact planes, whose directions come through the true mount. The belief and
/// `truth` are at the instant to which the IMU is integrated, by as much after the scan as the
/// delay of the belief is too large; a corrected delay moves both.
Belief after_planes(const Belief& belief, NominalState& truth, const Eigen::Vector3d& gyro,
                    RandomStream& random) {
  const CalibrationModel model{kMount.translation, {truth.velocity, gyro - truth.gyro_bias}};
  const Eigen::Matrix3d R = belief.state.rotation.toRotationMatrix();
  const NominalState at_scan = moved_on(truth, truth.delay - belief.state.delay, model.twist);
  Matrix6 A = Matrix6::Zero();
  Vector6 b = Vector6::Zero();
  for (int i = 0; i < 30; ++i) {
    const Plane plane{Eigen::Vector3d::Unit(i % 3), 3.0 * Eigen::Vector3d::Unit(i % 3), true};
    Eigen::Vector3d p_odom = 4.0 * random.normal3();
    p_odom(i % 3) = 3.0 + kPlaneSigma * random.normal();
    const Eigen::Vector3d p_lidar =
        (at_scan.T_odom_body() * corrected_mount(truth, kMount)).inverse() * p_odom;
    const Eigen::Vector3d p_body = corrected_mount(belief.state, kMount) * p_lidar;
    const PlaneRow row = plane_row(plane, p_body, R, belief.state.position);
    A += row.jacobian * row.jacobian.transpose() / (kPlaneSigma * kPlaneSigma);
    b += row.jacobian * row.residual / (kPlaneSigma * kPlaneSigma);
  }
  const Belief updated = fuse(belief, belief.state, scan_measurement(A, b, model, R));
  const double change = updated.state.delay - belief.state.delay;
  truth = moved_on(truth, change, model.twist);
  return after_delay_change(updated, change, model.twist);
}

/// One run of propagation, leg updates and updates by exact planes, all with noise drawn from their
/// models; the normalised squared error of the belief at the end, chi-square with as many degrees
/// of freedom as the error state has. The belief starts at the clock of its own delay.
double normalised_error_of_a_run(std::uint64_t seed) {
  RandomStream random(seed, "nees");
  const ImuPropagationConfig imu;
  Belief belief{test::some_state(), 1e-4 * ErrorMatrix::Identity()};
  constexpr double kDelaySigma = 2e-3;
  belief.covariance(ErrorState::kDelay, ErrorState::kDelay) = kDelaySigma * kDelaySigma;
  NominalState truth =
      boxplus(belief.state, test::square_root(belief.covariance) * normal_error(random));
  for (int step = 0; step < 200; ++step) {
    const Eigen::Vector3d rate(0.3 * std::sin(0.1 * step), 0.2, 0.1);
    const Eigen::Vector3d force(std::cos(0.05 * step), 0.5, 9.81);
    const InertialSegment real{
        0,     from_seconds(kStep), rate + truth.gyro_bias, force + truth.accelerometer_bias, true,
        kWhite};
    truth = propagate_state(truth, real, kStep, imu.gravity);
    // The model's noise acts on the state, so it is drawn there.
    const ErrorMatrix Q = propagation_noise(imu, kWhite, kStep);
    truth = boxplus(truth, test::square_root(Q) * normal_error(random));
    belief = propagate(belief, real, kStep, imu);
    if (step % 2 == 0) belief = after_legs(belief, truth, real.angular_velocity, random);
    if (step % 5 == 0) belief = after_planes(belief, truth, real.angular_velocity, random);
  }
  const ErrorVector error = boxminus(truth, belief.state);
  return error.dot(belief.covariance.llt().solve(error));
}

TEST(KalmanUpdate, NormalisedErrorLiesWithinItsChiSquareBounds) {
  constexpr int kRuns = 50;
  double sum = 0.0;
  for (int run = 0; run < kRuns; ++run) {
    sum += normalised_error_of_a_run(static_cast<std::uint64_t>(100 + run));
  }
  // The sum is chi-square with 1250 dof: 99.9 % of it lies within these bounds.
  EXPECT_GT(sum, 1092.0) << "seeds 100 to 149";
  EXPECT_LT(sum, 1421.0) << "seeds 100 to 149";
}

}  // namespace
}  // namespace aims
