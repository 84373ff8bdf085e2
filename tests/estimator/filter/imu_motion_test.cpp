// SPDX-License-Identifier: BSD-3-Clause
// Integration of sampled motions whose truth is known in closed form.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "estimator/filter/imu_history.hpp"

namespace aims {
namespace {

constexpr double kRate = 200.0;  // [Hz]
constexpr double kStep = 0.005;  // [s]
constexpr double kSeconds = 10.0;
constexpr double kOmega = 2.0 * M_PI * 10.0;  // of the motions [rad/s]

using Signal = std::function<ImuSample(double)>;

/// The state after the integration from `begin` to `end` [s] of samples at kRate, which carry
/// stamps `late` [s] behind the instant that they measure; `delay` [s] is told to the history.
NominalState integrate(const Signal& signal, const NominalState& start, double begin, double end,
                       double late = 0.0, double delay = 0.0) {
  ImuHistory history(ImuPropagationConfig{}, kRate);
  history.set_delay(from_seconds(delay));
  const int last = static_cast<int>(std::lround((end + 0.1) / kStep));
  for (int i = -10; i <= last; ++i) {
    ImuSample sample = signal(i * kStep - late);
    sample.stamp = from_seconds(i * kStep);
    history.insert(sample);
  }
  std::vector<InertialSegment> segments;
  history.segments(from_seconds(begin), from_seconds(end), segments);
  NominalState state = start;
  for (const InertialSegment& each : segments) {
    state = propagate_state(state, each, to_seconds(each.end - each.begin), 0.0);
  }
  return state;
}

/// The same with the mean of both ends of each interval, and nothing else.
NominalState integrate_means(const Signal& signal, const NominalState& start, double end) {
  NominalState state = start;
  const int count = static_cast<int>(std::lround(end / kStep));
  for (int i = 0; i < count; ++i) {
    const ImuSample a = signal(i * kStep);
    const ImuSample b = signal((i + 1) * kStep);
    const InertialSegment mean{0,
                               0,
                               0.5 * (a.angular_velocity + b.angular_velocity),
                               0.5 * (a.specific_force + b.specific_force),
                               true,
                               {}};
    state = propagate_state(state, mean, kStep, 0.0);
  }
  return state;
}

/// Attitude whose z axis draws a cone of half the angle 0.1 rad without the body turning about it.
Eigen::Quaterniond coning_attitude(double t) {
  return so3_exp(0.1 * Eigen::Vector3d(std::cos(kOmega * t), std::sin(kOmega * t), 0.0));
}

ImuSample coning(double t) {
  constexpr double kDifference = 1e-5;
  ImuSample sample;
  sample.angular_velocity =
      so3_log(coning_attitude(t - kDifference).conjugate() * coning_attitude(t + kDifference)) /
      (2.0 * kDifference);
  return sample;
}

TEST(ImuMotion, TheConingTermKeepsTheAttitudeOfAConingBody) {
  NominalState start;
  start.rotation = coning_attitude(0.0);
  const Eigen::Quaterniond truth = coning_attitude(kSeconds);
  const double with = integrate(coning, start, 0.0, kSeconds).rotation.angularDistance(truth);
  const double without = integrate_means(coning, start, kSeconds).rotation.angularDistance(truth);
  EXPECT_GT(without, 0.02) << "without the term the body drifts";
  EXPECT_LT(with, 0.6 * without) << "half of it: the trapezoid flattens the oscillation as well";
}

/// Rocking about x in phase with a force along y: the force rectifies along z.
constexpr double kSway = 0.05;  // [rad]
constexpr double kPush = 5.0;   // [m/s^2]

ImuSample sculling(double t) {
  ImuSample sample;
  sample.angular_velocity.x() = kSway * kOmega * std::cos(kOmega * t);
  sample.specific_force.y() = kPush * std::sin(kOmega * t);
  return sample;
}

TEST(ImuMotion, TheScullingTermKeepsTheVelocityOfARockingBody) {
  // Of whole periods: the mean of f sin(theta) with theta = sway sin and f = push sin.
  constexpr int kParts = 100000;
  double truth = 0.0;
  for (int i = 0; i < kParts; ++i) {
    const double s = std::sin(2.0 * M_PI * i / kParts);
    truth += kSeconds * kPush * s * std::sin(kSway * s) / kParts;
  }
  const double with = integrate(sculling, {}, 0.0, kSeconds).velocity.z();
  const double without = integrate_means(sculling, {}, kSeconds).velocity.z();
  EXPECT_GT(std::abs(without - truth), 0.01) << "without the term the velocity drifts";
  EXPECT_LT(std::abs(with - truth), 0.6 * std::abs(without - truth));
}

TEST(ImuMotion, AKnownDelayIntegratesTheRotationOfItsTime) {
  const Signal nod = [](double t) {
    ImuSample sample;
    sample.angular_velocity.y() = 0.8 * std::cos(5.0 * t);
    return sample;
  };
  constexpr double kLate = 0.012;
  constexpr double kEnd = 0.3;  // where the rate is far from zero
  const double truth = 0.8 / 5.0 * std::sin(5.0 * kEnd);
  const auto angle = [&](double delay) {
    return so3_log(integrate(nod, {}, 0.0, kEnd, kLate, delay).rotation).y();
  };
  EXPECT_NEAR(angle(kLate), truth, 5e-5) << "cut segments have the mean of the whole";
  EXPECT_GT(std::abs(angle(0.0) - truth), 5e-3);
}

}  // namespace
}  // namespace aims
