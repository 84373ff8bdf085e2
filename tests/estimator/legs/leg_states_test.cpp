// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/legs/leg_states.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/random.hpp"

namespace aims {
namespace {

using E = ErrorState;

Belief fixed_legs() {
  Belief belief;
  belief.covariance = 1e-16 * ErrorMatrix::Identity();
  return belief;
}

TEST(LegStates, OnlyEnabledStatesGetVariance) {
  LegStatesConfig config;
  config.scale_sigma = 0.1;
  const Belief fixed = open_leg_states(fixed_legs(), config);
  EXPECT_EQ(fixed.covariance, fixed_legs().covariance);
  config.enabled = true;
  const Belief open = open_leg_states(fixed_legs(), config);
  EXPECT_NEAR(block(open.covariance, E::kLegScale, E::kLegScale)(1, 1), 0.01, 1e-12);
  EXPECT_NEAR(block(open.covariance, E::kLegBias, E::kLegBias)(1, 1), kLegBiasSigma * kLegBiasSigma,
              1e-12);
}

TEST(LegStates, VarianceGrowsWithTime) {
  LegStatesConfig config;
  config.enabled = true;
  Belief belief = fixed_legs();
  for (int i = 0; i < 100; ++i) walk_leg_states(belief, config, 0.05);
  EXPECT_NEAR(block(belief.covariance, E::kLegScale, E::kLegScale)(0, 0),
              5.0 * kLegScaleWalk * kLegScaleWalk, 1e-12);
  EXPECT_NEAR(block(belief.covariance, E::kLegBias, E::kLegBias)(2, 2),
              5.0 * kLegBiasWalk * kLegBiasWalk, 1e-14);
}

TEST(LegStates, FeetOnSoftJointsHaveAScaleThatIsLessCertain) {
  EXPECT_EQ(feet_scale_sigma(0.0), kFeetScaleSigma);
  EXPECT_EQ(feet_scale_sigma(0.08), kFeetScaleSigma);
  EXPECT_NEAR(feet_scale_sigma(0.1), 0.08, 1e-12);
}

/// The belief of a robot that walks along x by legs whose scale is uncertain by `sigma`, and is not
/// corrected; something measures its position weakly.
Belief walked_with_scale(double sigma) {
  Belief belief = fixed_legs();
  block(belief.covariance, E::kLegScale, E::kLegScale) =
      sigma * sigma * Eigen::Matrix3d::Identity();
  LinearMeasurement legs;
  columns(legs.jacobian, E::kVelocity).setIdentity();
  columns(legs.jacobian, E::kLegScale) = Eigen::Vector3d(0.7, 0.1, 0.0).asDiagonal();
  legs.noise = 0.01 * Eigen::Matrix3d::Identity();
  ErrorMatrix step = ErrorMatrix::Identity();
  block(step, E::kPosition, E::kVelocity) = 0.01 * Eigen::Matrix3d::Identity();
  for (int i = 0; i < 1000; ++i) {
    belief.covariance = step * belief.covariance * step.transpose();
    block(belief.covariance, E::kVelocity, E::kVelocity).diagonal().array() += 1e-4;
    belief = fuse_given_legs(belief, legs);
  }
  return belief;
}

// What a filter states that has started with the larger deviation of the scale.
TEST(LegStates, AddWhatALessCertainScaleMakesOfThePosition) {
  const Belief belief = walked_with_scale(0.04);
  const Belief expected = walked_with_scale(0.1);
  const Eigen::Matrix3d more =
      (0.1 * 0.1 / (0.04 * 0.04) - 1.0) * position_covariance_by_leg_scale(belief);
  const Eigen::Matrix3d difference = block(expected.covariance, E::kPosition, E::kPosition) -
                                     block(belief.covariance, E::kPosition, E::kPosition);
  ASSERT_GT(more(0, 0), 0.1) << "the scale has something to do";
  EXPECT_LT((difference - more).norm(), 1e-9 * more.norm());
  EXPECT_TRUE(position_covariance_by_leg_scale(Belief{{}, ErrorMatrix::Zero()}).isZero(0.0));
}

constexpr Duration kPeriod = 5 * kMillisecond;

/// The means of a robot that walks at `speed(t)` along x, sample after sample.
class Walk {
 public:
  /// Adds the next sample.
  LegVelocity next(double speed) {
    return means_.update(stamp_ += kPeriod, speed * Eigen::Vector3d::UnitX());
  }

 private:
  StrideMeans means_;
  Time stamp_ = 0;
};

TEST(StrideMeans, KeepTheMeanAndDampTheOscillation) {
  Walk walk;
  double largest = 0.0;
  double largest_past = 0.0;
  for (int i = 0; i < 2000; ++i) {
    const LegVelocity legs = walk.next(0.7 + 0.1 * std::sin(2.0 * M_PI * 4.0 * i * 0.005));
    if (i < 1000) continue;
    largest = std::max(largest, std::abs(legs.stride_mean.x() - 0.7));
    largest_past = std::max(largest_past, std::abs(legs.past_mean.x() - 0.7));
  }
  EXPECT_LT(largest, 0.1 * 0.18);
  EXPECT_LT(largest_past, 0.1 * 0.01);
}

// The velocity less scale times mean is integrated to the position: a mean that lags by half a
// second moves a robot with a scale of 0.2 by 5 cm at each start and stop at 0.5 m/s.
TEST(StrideMeans, DoNotLagOverAStartAndAStop) {
  Walk walk;
  double apart = 0.0;  // of the distance by samples and by their mean [m]
  const auto add = [&](double speed) {
    apart += (speed - walk.next(speed).stride_mean.x()) * to_seconds(kPeriod);
  };
  for (int i = 0; i < 200; ++i) add(0.0);
  for (int i = 0; i < 100; ++i) add(0.005 * i);
  for (int i = 0; i < 1000; ++i) add(0.5);
  EXPECT_NEAR(apart, 0.0, 2e-3) << "walking";
  for (int i = 0; i < 1000; ++i) add(0.0);
  EXPECT_NEAR(apart, 0.0, 2e-3) << "standing";
}

/// The scale that a filter learns whose velocity is known, less the true one [-].
double error_of_learned_scale(std::uint64_t seed) {
  constexpr double kSpeed = 0.5;
  constexpr double kScale = -0.14;
  constexpr double kNoise = 0.4;
  RandomStream random(seed, "noise");
  Belief belief = fixed_legs();
  belief.state.velocity.x() = kSpeed;
  block(belief.covariance, E::kLegScale, E::kLegScale) = 0.0144 * Eigen::Matrix3d::Identity();
  const Eigen::Matrix3d noise = kNoise * kNoise * Eigen::Matrix3d::Identity();
  Walk walk;
  for (int i = 0; i < 20000; ++i) {
    const LegVelocity legs = walk.next((1.0 + kScale) * kSpeed + kNoise * random.normal());
    belief = fuse(belief,
                  leg_velocity_model(belief.state, Pose{}, Eigen::Vector3d::Zero(), legs, noise));
    belief.state.velocity = kSpeed * Eigen::Vector3d::UnitX();
  }
  // Of the mean reported: velocity = reported - scale * reported.
  return belief.state.leg_scale.x() - kScale / (1.0 + kScale);
}

// Errors in variables: were the Jacobian the mean that contains the sample, its noise, 0.4 m/s,
// would be taken as a scale of 0.018.
TEST(StrideMeans, TheNoiseOfASampleIsNotTakenAsScale) {
  double mean = 0.0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) mean += error_of_learned_scale(seed) / 20.0;
  EXPECT_NEAR(mean, 0.0, 0.005);
}

}  // namespace
}  // namespace aims
