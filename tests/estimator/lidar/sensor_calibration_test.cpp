// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/lidar/sensor_calibration.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "core/random.hpp"
#include "estimator/filter/imu_history.hpp"
#include "estimator/lidar/plane_model.hpp"
#include "tests/estimator/finite_differences.hpp"

namespace aims {
namespace {

using E = ErrorState;

const Pose kNominal{so3_exp({0.0, 0.3, 0.1}), {0.2, -0.1, 0.15}};  // of the mount
const MeanTwist kTwist{{0.7, -0.2, 0.1}, {0.3, -0.4, 0.8}};

/// A plane with nothing special about it, and a return of the LiDAR near it.
const Plane kPlane{Eigen::Vector3d(0.2, -0.5, 0.7).normalized(), {5.0, 1.0, 2.0}, true};
const Eigen::Vector3d kReturn(3.0, -4.0, 1.5);

/// The residual of the return at `state`; a larger delay than that of `reference` integrates the
/// motion further.
double residual_at(const NominalState& state, const NominalState& reference) {
  const double change = state.delay - reference.delay;
  const NominalState later = after_delay_change(Belief{state}, change, kTwist).state;
  const Eigen::Vector3d p_body = corrected_mount(state, kNominal) * kReturn;
  return plane_row(kPlane, p_body, later.rotation.toRotationMatrix(), later.position).residual;
}

/// The row of the return as scan_measurement() forms it, over the whole error.
ErrorVector row_at(const NominalState& state) {
  const Eigen::Matrix3d R = state.rotation.toRotationMatrix();
  const Eigen::Vector3d p_body = corrected_mount(state, kNominal) * kReturn;
  const Vector6 j = plane_row(kPlane, p_body, R, state.position).jacobian;
  return scan_measurement({}, j, {kNominal.translation, kTwist}, R).jacobian.transpose() * j;
}

TEST(SensorCalibration, DerivativeMatchesFiniteDifferences) {
  const NominalState state = test::some_state();
  const auto numeric = test::numeric_jacobian<1>(state, [&](const NominalState& moved) {
    return Eigen::Matrix<double, 1, 1>(residual_at(moved, state));
  });
  const ErrorVector row = row_at(state);
  EXPECT_LT((row.transpose() - numeric).cwiseAbs().maxCoeff(), 1e-7);
  EXPECT_GT(segment(row, E::kMount).norm(), 0.1) << "something was tested";
  EXPECT_GT(std::abs(row(E::kDelay)), 0.1);
}

// With the body points of another mount and delay a return lies in the same place.
TEST(SensorCalibration, ScanPoseMakesUpForThePointsOfAnotherCalibration) {
  const NominalState state = test::some_state();
  NominalState later = state;
  later.mount = so3_exp({0.003, -0.002, 0.004}) * state.mount;
  later.delay = state.delay + 0.002;
  const CalibrationModel points{kNominal.translation, kTwist, state.mount, state.delay};
  const Eigen::Vector3d p_body = corrected_mount(state, kNominal) * kReturn;
  const Pose pose = scan_pose(later, points);
  const double residual = plane_row(kPlane, p_body, pose.R(), pose.translation).residual;
  EXPECT_NEAR(residual, residual_at(later, state), 1e-4);
  EXPECT_GT(std::abs(residual - residual_at(state, state)), 1e-3) << "something was tested";
  const Pose back = at_scan_pose(later, pose, points).T_odom_body();
  EXPECT_LT((back.translation - later.position).norm(), 1e-12);
  EXPECT_LT(back.rotation.angularDistance(later.rotation), 1e-12);
}

TEST(SensorCalibration, OpensWithHalfOfTheLargestDelay) {
  Belief belief;
  belief.covariance = 1e-16 * ErrorMatrix::Identity();
  CalibrationConfig config;
  const Belief open = open_calibration(belief, config, 50.0);
  EXPECT_DOUBLE_EQ(open.state.delay, 0.005) << "an instant: 0, the mean over 20 ms: 10 ms";
  const double variance = config.delay_sigma * config.delay_sigma + 0.005 * 0.005;
  EXPECT_NEAR(open.covariance(E::kDelay, E::kDelay), variance, 1e-12);
  const int m = E::kMount.offset;
  EXPECT_NEAR(open.covariance(m + 1, m + 1), config.mount_sigma * config.mount_sigma, 1e-12);
  config.enabled = false;
  const Belief known = open_calibration(belief, config, 50.0);
  EXPECT_EQ(known.covariance, belief.covariance);
}

/// Position error at `now` of an estimate that has the LiDAR's path right in the axes of its gyro,
/// takes the LiDAR to be `lever` off where it is, and starts with the true heading.
Eigen::Vector3d error_by_rig(const Pose& first, const Pose& now, const Eigen::Vector3d& lever,
                             const Eigen::Vector3d& axes) {
  const Eigen::Vector3d mount(0.05, 0.0, 0.02);
  const auto attitude_of_gyro = [&](const Pose& pose) {
    return Eigen::Matrix3d(pose.R() * so3_exp(axes).toRotationMatrix());
  };
  const auto heading = [](const Eigen::Matrix3d& R) { return std::atan2(R(1, 0), R(0, 0)); };
  const double turn = heading(first.R()) - heading(attitude_of_gyro(first));
  const Eigen::Matrix3d Z = so3_exp({0.0, 0.0, turn}).toRotationMatrix();
  const auto estimate = [&](const Pose& pose) {
    const Eigen::Vector3d lidar = pose * mount;
    return Eigen::Vector3d(Z * (lidar - attitude_of_gyro(pose) * (mount - lever)));
  };
  return estimate(now) - estimate(first) - (now.translation - first.translation);
}

TEST(SensorCalibration, CovarianceByTheRigIsThatOfDrawnErrors) {
  const CalibrationConfig config;
  const Pose first{so3_exp({0.02, -0.03, 0.4}), {1.0, 2.0, 0.3}};
  const Pose away{so3_exp({0.03, 0.02, 0.3}), {11.0, 6.0, 0.35}};
  const Pose returned{so3_exp({-0.02, 0.05, 3.4}), {1.5, 2.2, 0.3}};
  for (const Pose& now : {away, returned}) {
    RandomStream random = rng(1, "rig");
    Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
    constexpr int kDraws = 20'000;
    for (int i = 0; i < kDraws; ++i) {
      const Eigen::Vector3d error = error_by_rig(first, now, kLeverSigma * random.normal3(),
                                                 config.mount_sigma * random.normal3());
      sum += error * error.transpose() / kDraws;
    }
    const Eigen::Matrix3d stated = rig_covariance(first, now, config);
    EXPECT_LT((stated - sum).norm(), 0.05 * sum.norm()) << stated << "\n" << sum;
    EXPECT_GT(sum.norm(), 1e-5) << "something was tested";
  }
  EXPECT_TRUE(rig_covariance(first, first, config).isZero());
  EXPECT_TRUE(
      rig_covariance(first, away, {.enabled = false, .mount_sigma = 5e-3, .delay_sigma = 2e-3})
          .isZero());
}

TEST(SensorCalibration, WalksWithTime) {
  Belief belief;
  belief.covariance.setZero();
  CalibrationConfig config;
  for (int i = 0; i < 100; ++i) walk_calibration(belief, config, 0.1);
  const double delay = kDelayWalk * kDelayWalk * 10.0;
  const double mount = kMountWalk * kMountWalk * 10.0;
  EXPECT_NEAR(belief.covariance(E::kDelay, E::kDelay), delay, 1e-6 * delay);
  EXPECT_NEAR(belief.covariance(E::kMount.offset, E::kMount.offset), mount, 1e-6 * mount);
  EXPECT_EQ((belief.covariance.topLeftCorner<21, 21>().norm()), 0.0);
  const Belief before = belief;
  config.enabled = false;
  walk_calibration(belief, config, 1.0);
  EXPECT_EQ(belief.covariance, before.covariance);
}

TEST(SensorCalibration, MeanTwistIsThatOfTheMotion) {
  const InertialSegment turn{0, kSecond / 10, {0.0, 0.0, 0.5}, {0.0, 1.0, 9.81}, true, {}};
  NominalState begin;
  begin.velocity = {2.0, 0.0, 0.0};
  const NominalState end = propagate_state(begin, turn, 0.1, 9.81);
  const MeanTwist twist = mean_twist(end, std::span(&turn, 1), 9.81);
  EXPECT_LT((twist.velocity - 10.0 * end.position).norm(), 1e-7);
  EXPECT_LT((twist.angular_velocity - Eigen::Vector3d(0.0, 0.0, 0.5)).norm(), 1e-9);
  const MeanTwist none = mean_twist(end, {}, 9.81);
  EXPECT_EQ(none.velocity, end.velocity);
  EXPECT_EQ(none.angular_velocity.norm(), 0.0);
}

/// The true motion, by time [s]: swaying along and turning about every axis.
NominalState motion(double t) {
  NominalState state;
  state.rotation = so3_exp({0.2 * std::sin(2.1 * t), 0.15 * std::sin(2.7 * t), std::sin(0.9 * t)});
  state.position = {std::sin(0.8 * t), 0.5 * std::sin(1.3 * t), 0.3 * std::sin(1.9 * t)};
  state.velocity = {0.8 * std::cos(0.8 * t), 0.65 * std::cos(1.3 * t), 0.57 * std::cos(1.9 * t)};
  return state;
}

/// What an IMU measures at that instant.
ImuSample imu_at(double t) {
  constexpr double kDifference = 1e-4;
  const NominalState before = motion(t - kDifference);
  const NominalState after = motion(t + kDifference);
  ImuSample sample;
  sample.angular_velocity =
      so3_log(before.rotation.conjugate() * after.rotation) / (2.0 * kDifference);
  const Eigen::Vector3d acceleration = (after.velocity - before.velocity) / (2.0 * kDifference);
  sample.specific_force =
      motion(t).rotation.conjugate() * (acceleration + Eigen::Vector3d(0.0, 0.0, 9.81));
  return sample;
}

/// A filter that knows six walls and estimates mount and delay, at the rate of a LiDAR.
class CalibratedBody {
 public:
  CalibratedBody(const Eigen::Vector3d& mount, double delay, bool enabled)
      : mount_(so3_exp(mount)), delay_(delay) {
    config_.enabled = enabled;
    belief_.covariance = 1e-16 * ErrorMatrix::Identity();
    belief_.covariance.topLeftCorner<E::kMotionSize, E::kMotionSize>() *= 1e8;
    belief_ = open_calibration(belief_, config_, kRate);
    const double first_delay = belief_.state.delay;
    belief_.state = motion(first_delay - delay_);
    belief_.state.delay = first_delay;
    imu_.set_delay(from_seconds(belief_.state.delay));
    for (int i = -20; i < 60 * kRate; ++i) {
      ImuSample sample = imu_at(i / kRate);
      sample.stamp = from_seconds(i / kRate + delay_);
      sample.angular_velocity += 1e-3 * random_.normal3();
      sample.specific_force += 1e-2 * random_.normal3();
      imu_.insert(sample);
    }
  }

  /// Scans ten times a second until `end` [s].
  void run(double end) {
    for (int k = 1; 0.1 * k < end; ++k) scan(0.1 * k);
  }

  const Belief& belief() const { return belief_; }

 private:
  static constexpr double kRate = 100.0;
  static constexpr double kSigma = 0.01;

  void scan(double t) {
    imu_.segments(from_seconds(t - 0.1), from_seconds(t), segments_);
    for (InertialSegment& each : segments_) {
      each.noise = {1e-3, 1e-2};
      belief_ = propagate(belief_, each, to_seconds(each.end - each.begin), {});
    }
    walk_calibration(belief_, config_, 0.1);
    const MeanTwist twist = mean_twist(belief_.state, segments_, 9.81);
    const double before = belief_.state.delay;
    belief_ = fuse(belief_, belief_.state, measure(motion(t), {kNominal.translation, twist}));
    belief_ = after_delay_change(belief_, belief_.state.delay - before, twist);
    imu_.set_delay(from_seconds(belief_.state.delay));
  }

  /// Returns of six walls, fired through the true mount at the true pose.
  PoseMeasurement measure(const NominalState& truth, const CalibrationModel& model) {
    const Eigen::Matrix3d R = belief_.state.rotation.toRotationMatrix();
    const Pose T_body_lidar{mount_ * kNominal.rotation, kNominal.translation};
    const Pose T_lidar_odom = (truth.T_odom_body() * T_body_lidar).inverse();
    Matrix6 A = Matrix6::Zero();
    Vector6 b = Vector6::Zero();
    for (int i = 0; i < 60; ++i) {
      const Eigen::Vector3d normal = (i % 2 == 0 ? 1.0 : -1.0) * Eigen::Vector3d::Unit(i % 3);
      const Plane wall{normal, 4.0 * normal, true};
      Eigen::Vector3d p = 2.0 * random_.normal3();
      p(i % 3) = 4.0 * normal(i % 3) + kSigma * random_.normal();
      const Eigen::Vector3d p_body = corrected_mount(belief_.state, kNominal) * (T_lidar_odom * p);
      const PlaneRow row = plane_row(wall, p_body, R, belief_.state.position);
      A += row.jacobian * row.jacobian.transpose() / (kSigma * kSigma);
      b += row.jacobian * row.residual / (kSigma * kSigma);
    }
    return scan_measurement(A, b, model, R);
  }

  CalibrationConfig config_;
  Eigen::Quaterniond mount_;
  double delay_;
  RandomStream random_{1, "sensor_calibration"};
  ImuHistory imu_{ImuPropagationConfig{}, kRate};
  Belief belief_;
  std::vector<InertialSegment> segments_;
};

TEST(SensorCalibration, AMovingBodyFindsItsMountAndItsDelay) {
  const Eigen::Vector3d mount(0.006, -0.004, 0.008);
  for (const double delay : {0.0, 0.004, 0.009}) {
    CalibratedBody body(mount, delay, true);
    body.run(30.0);
    const Belief& belief = body.belief();
    EXPECT_NEAR(belief.state.delay, delay, 3e-4);
    EXPECT_LT((so3_log(belief.state.mount) - mount).norm(), 1e-3) << "delay " << delay;
    const double stated = std::sqrt(belief.covariance(E::kDelay, E::kDelay));
    EXPECT_LT(std::abs(belief.state.delay - delay), 4.0 * stated + 1e-5);
    EXPECT_LT(stated, 5e-4);
  }
}

TEST(SensorCalibration, DisabledItKeepsBoth) {
  CalibratedBody body({0.006, -0.004, 0.008}, 0.004, false);
  body.run(3.0);
  EXPECT_NEAR(body.belief().state.delay, 0.0025, 1e-5);
  EXPECT_LT(so3_log(body.belief().state.mount).norm(), 1e-4);
}

}  // namespace
}  // namespace aims
