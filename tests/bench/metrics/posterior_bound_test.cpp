// SPDX-License-Identifier: BSD-3-Clause
#include "bench/metrics/posterior_bound.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "core/random.hpp"
#include "tests/bench/metrics/bound_motions.hpp"

namespace aims {
namespace {

using Eigen::Vector3d;
using testing::certain;
using testing::curved_motion;
using testing::kMotionStep;
using testing::straight_motion;

std::vector<ScanInformation> scans_at(const std::vector<double>& seconds,
                                      const Eigen::Matrix<double, 6, 6>& information) {
  std::vector<ScanInformation> scans;
  for (const double t : seconds) scans.push_back({from_seconds(t), information, 1, 0.02});
  return scans;
}

const Eigen::Matrix<double, 6, 6> kNothing = Eigen::Matrix<double, 6, 6>::Zero();

TEST(PosteriorBound, OfAccelerometerNoiseAloneGrowsAsItsSecondIntegral) {
  BoundParameters p = certain();
  p.accelerometer.noise_density = 0.01;
  p.initial.velocity_sigma = 0.05;
  const auto bounds =
      posterior_bounds(straight_motion(10, 0.0), scans_at({5.0, 10.0}, kNothing), p);
  ASSERT_EQ(bounds.size(), 2U);
  for (const auto& [bound, t] : {std::pair(bounds[0], 5.0), std::pair(bounds[1], 10.0)}) {
    const double expected = std::sqrt(1e-4 * t * t * t / 3.0 + 0.05 * 0.05 * t * t);
    EXPECT_NEAR(bound.longitudinal, expected, 1e-3 * expected);
    EXPECT_NEAR(bound.lateral, expected, 1e-3 * expected);
  }
}

TEST(PosteriorBound, OfAnUnknownBiasAndTiltIsTheirParabola) {
  BoundParameters p = certain();
  p.accelerometer.bias_sigma = 0.03;
  p.initial.tilt_sigma = 0.004;
  const auto bounds = posterior_bounds(straight_motion(8, 0.0), scans_at({8.0}, kNothing), p);
  const double horizontal = 0.5 * 64.0 * std::hypot(0.03, 9.81 * 0.004);
  EXPECT_NEAR(bounds[0].longitudinal, horizontal, 1e-3 * horizontal);
  EXPECT_NEAR(bounds[0].vertical, 0.5 * 64.0 * 0.03, 1e-3);
}

TEST(PosteriorBound, OfAnUnknownLegScaleIsThatFractionOfTheDistance) {
  BoundParameters p = certain();
  // An IMU that says nothing of speed, and legs without noise: what remains is their scale.
  p.accelerometer.noise_density = 0.1;
  p.legs = {true, 200.0, 1e-5, 0.03};
  const auto bounds = posterior_bounds(straight_motion(50, 0.7), scans_at({50.0}, kNothing), p);
  EXPECT_NEAR(bounds[0].longitudinal, 0.03 * 35.0, 0.02);
  EXPECT_LT(bounds[0].lateral, 0.01);
  EXPECT_NEAR(bounds[0].leg_scale, 0.03, 1e-4);
}

TEST(PosteriorBound, OneLongitudinallyInformativeScanDeterminesTheLegScale) {
  BoundParameters p = certain();
  p.accelerometer.noise_density = 0.1;
  p.legs = {true, 200.0, 1e-5, 0.03};
  const Eigen::Matrix<double, 6, 6> seen =
      1e8 * Eigen::Matrix<double, 6, 6>::Identity();  // 0.1 mm, 0.1 mrad
  auto scans = scans_at({10.0}, seen);
  scans.push_back({from_seconds(50.0), kNothing, 0, 0.02});
  const auto bounds = posterior_bounds(straight_motion(50, 0.7), scans, p);
  EXPECT_NEAR(bounds[0].longitudinal, 1e-4, 2e-6);
  EXPECT_LT(bounds[1].leg_scale, 1e-3);
  EXPECT_LT(bounds[1].longitudinal, 0.05) << "against 1.05 m without the scan";
  p.lidar = false;
  EXPECT_GT(posterior_bounds(straight_motion(50, 0.7), scans, p)[1].longitudinal, 1.0);
}

/// Along one axis the recursion is the Riccati equation of position and velocity in closed form.
TEST(PosteriorBound, ReachesTheSteadyStateOfTheScalarRiccatiEquation) {
  BoundParameters p = certain();
  p.initial.velocity_sigma = 0.02;
  p.accelerometer.noise_density = 0.5;
  const double sigma = 0.004;
  Eigen::Matrix<double, 6, 6> information = kNothing;
  information.bottomRightCorner<3, 3>() = Eigen::Matrix3d::Identity() / (sigma * sigma);
  std::vector<double> times;
  for (int i = 1; i <= 200; ++i) times.push_back(0.1 * i);
  const auto bounds =
      posterior_bounds(straight_motion(20.01, 0.0), scans_at(times, information), p);
  Eigen::Matrix2d P = Eigen::Vector2d(1e-18, 4e-4).asDiagonal();
  const double dt = 0.1;
  Eigen::Matrix2d F;
  F << 1, dt, 0, 1;
  Eigen::Matrix2d Q;
  Q << dt * dt * dt / 3, dt * dt / 2, dt * dt / 2, dt;
  ASSERT_EQ(bounds.size(), times.size());
  for (const PosteriorBound& bound : bounds) {
    P = F * P * F.transpose() + 0.25 * Q;
    const Eigen::Vector2d gain = P.col(0) / (P(0, 0) + sigma * sigma);
    P -= gain * P.row(0).eval();
    EXPECT_NEAR(bound.longitudinal, std::sqrt(P(0, 0)), 1e-3 * std::sqrt(P(0, 0)));
  }
}

/// Simulates a linear world along x (position, speed, bias, leg scale through a varying speed) many
/// times, estimates with the optimal linear filter, and compares the spread with the bound.
TEST(PosteriorBound, IsTheSpreadOfTheOptimalFilterInALinearWorld) {
  const double acceleration = 0.1;
  const double force_density = 0.02;
  const double bias_sigma = 0.05;
  const double scale_sigma = 0.05;
  const double leg_sigma = 0.1;
  const double leg_rate = 50.0;
  const int steps = 300;
  const auto motion = straight_motion(steps * kMotionStep, 0.2, acceleration);
  BoundParameters p = certain();
  p.accelerometer = {force_density, 0.0, bias_sigma};
  p.legs = {true, leg_rate, leg_sigma, scale_sigma};
  p.initial.velocity_sigma = 1.0;  // the start moves: the bound supposes this anyway
  const double bound =
      posterior_bounds(motion, scans_at({steps * kMotionStep}, kNothing), p)[0].longitudinal;

  using Vector4 = Eigen::Vector4d;  // position, speed, bias, scale
  RandomStream random(11, "test.filter");
  Eigen::Matrix4d F = Eigen::Matrix4d::Identity();
  F(0, 1) = kMotionStep;
  F(0, 2) = -0.5 * kMotionStep * kMotionStep;
  F(1, 2) = -kMotionStep;
  const double density = force_density * force_density;
  Eigen::Matrix4d Q = Eigen::Matrix4d::Zero();
  Q.topLeftCorner<2, 2>() << density * kMotionStep * kMotionStep * kMotionStep / 3,
      density * kMotionStep * kMotionStep / 2, density * kMotionStep * kMotionStep / 2,
      density * kMotionStep;
  const Eigen::Matrix2d root = Q.topLeftCorner<2, 2>().llt().matrixL();
  const int draws = 4000;  // sampling error of the deviation: 1.1 %
  double squared = 0.0;
  for (int draw = 0; draw < draws; ++draw) {
    Vector4 truth(0.0, random.normal(), bias_sigma * random.normal(),
                  scale_sigma * random.normal());
    Vector4 estimate = Vector4::Zero();  // of the error state about the nominal motion
    Eigen::Matrix4d P =
        Vector4(1e-18, 1.0, bias_sigma * bias_sigma, scale_sigma * scale_sigma).asDiagonal();
    for (int i = 1; i <= steps; ++i) {
      truth = F * truth;
      truth.head<2>() += root * Eigen::Vector2d(random.normal(), random.normal());
      const Vector4 h(0.0, 1.0, 0.0, motion[static_cast<std::size_t>(i)].velocity.x());
      const double z = h.dot(truth) + leg_sigma * random.normal();
      estimate = F * estimate;
      P = F * P * F.transpose() + Q;
      const Vector4 gain = P * h / (h.dot(P * h) + leg_sigma * leg_sigma);
      estimate += gain * (z - h.dot(estimate));
      P -= gain * (P * h).transpose().eval();
    }
    squared += std::pow(truth[0] - estimate[0], 2);
  }
  EXPECT_NEAR(std::sqrt(squared / draws), bound, 0.05 * bound);
}

/// Heading cannot be told from inside: what the IMU integrates and what the legs report turn
/// together. A wrong sign in either model would make it observable.
TEST(PosteriorBound, HeadingIsUnobservableFromImuAndLegs) {
  BoundParameters p = certain();
  p.initial.heading_sigma = 0.01;
  p.accelerometer.noise_density = 1e-4;
  p.legs = {true, 200.0, 1e-3, 0.0};
  const auto motion = straight_motion(10, 0.0, 0.1);
  const auto bounds = posterior_bounds(motion, scans_at({10.0}, kNothing), p);
  EXPECT_NEAR(bounds[0].heading, 0.01, 1e-4);
  EXPECT_NEAR(bounds[0].lateral, 0.01 * 5.0, 1e-3);
}

/// Integrates the true motion's own rates with wrong initial attitude, velocity and biases, without
/// linearising anything, and compares the spread with the bound.
TEST(PosteriorBound, IsTheSpreadOfInertialIntegrationAlongACurve) {
  BoundParameters p = certain();
  p.gyro.bias_sigma = 2e-3;
  p.accelerometer.bias_sigma = 0.02;
  p.initial.tilt_sigma = 3e-3;
  p.initial.heading_sigma = 3e-3;
  const auto motion = curved_motion(6.0);
  const PosteriorBound bound = posterior_bounds(motion, scans_at({6.0}, kNothing), p)[0];
  RandomStream random(3, "test.curve");
  const int draws = 1500;  // sampling error of a deviation: 1.8 %
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (int draw = 0; draw < draws; ++draw) {
    Pose pose = motion[0].T_world_body;
    pose.rotation = pose.rotation * so3_exp(3e-3 * random.normal3());
    Vector3d velocity = motion[0].velocity;
    const Vector3d turn = 2e-3 * random.normal3();
    const Vector3d push = 0.02 * random.normal3();
    for (std::size_t i = 1; i < motion.size(); ++i) {
      const TrueMotion& a = motion[i - 1];
      const TrueMotion& b = motion[i];
      const Vector3d gravity(0.0, 0.0, -9.81);
      const Vector3d force =
          a.T_world_body.rotation.conjugate() * ((b.velocity - a.velocity) / kMotionStep - gravity);
      const Vector3d gained = pose.rotation * (force + push) + gravity;
      pose.translation += velocity * kMotionStep + 0.5 * kMotionStep * kMotionStep * gained;
      velocity += kMotionStep * gained;
      const Vector3d rate =
          so3_log(a.T_world_body.rotation.conjugate() * b.T_world_body.rotation) / kMotionStep;
      pose.rotation = pose.rotation * so3_exp((rate + turn) * kMotionStep);
    }
    const Vector3d error = pose.translation - motion.back().T_world_body.translation;
    covariance += error * error.transpose() / draws;
  }
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(std::sqrt(covariance(i, i) / bound.position(i, i)), 1.0, 0.08) << "axis " << i;
  }
}

TEST(PosteriorBound, AScanInformsAlongTheBodysOwnAxes) {
  BoundParameters p = certain();
  p.initial.position_sigma = 1.0;
  auto motion = straight_motion(1.0, 0.0);
  for (TrueMotion& at : motion) at.T_world_body.rotation = yaw_rotation(0.7);
  Eigen::Matrix<double, 6, 6> ahead = kNothing;
  ahead(3, 3) = 1e4;
  const PosteriorBound bound = posterior_bounds(motion, scans_at({1.0}, ahead), p)[0];
  EXPECT_NEAR(bound.longitudinal, 0.01, 1e-5);
  EXPECT_NEAR(bound.lateral, 1.0, 1e-3);
  EXPECT_NEAR(bound_along(bound, {std::cos(0.7), std::sin(0.7), 0.0}), 0.01, 1e-5);
}

TEST(PosteriorBound, HasAnEntryPerScanInsideTheMotionAndNoneWithoutMotion) {
  const auto motion = straight_motion(1.0, 0.5);
  const auto scans = scans_at({-0.1, 0.0, 0.25, 1.0, 1.1}, kNothing);
  const auto bounds = posterior_bounds(motion, scans, certain());
  ASSERT_EQ(bounds.size(), 3U);
  EXPECT_EQ(bounds[1].stamp, from_seconds(0.25));
  EXPECT_TRUE(posterior_bounds({}, scans, certain()).empty());
}

}  // namespace
}  // namespace aims
