// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/legs/leg_gate.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "estimator/legs/leg_velocity_model.hpp"

namespace aims {
namespace {

constexpr double kRate = 200.0;
constexpr Duration kPeriod = 5 * kMillisecond;
constexpr double kSigma = 0.04;       // of a sample [m/s]
constexpr double kStateSigma = 0.03;  // of the velocity [m/s]

/// The gate, its samples of noise kSigma and a state whose velocity is kStateSigma uncertain.
class GatedWalk {
 public:
  /// The factor on the noise of the next sample, off by `residual` [m/s]; empty: rejected.
  std::optional<double> next(double residual) {
    LinearMeasurement measurement;
    columns(measurement.jacobian, ErrorState::kVelocity).setIdentity();
    columns(measurement.jacobian, ErrorState::kLegScale) = 0.7 * Eigen::Matrix3d::Identity();
    measurement.residual = Eigen::Vector3d(residual, 0.0, 0.0);
    LegConfig legs;
    legs.velocity_sigma.setConstant(kSigma);
    legs.scale_sigma = 0.0;
    measurement.noise = leg_velocity_noise(legs, kRate, Eigen::Vector3d::Zero());
    ErrorMatrix covariance = kStateSigma * kStateSigma * ErrorMatrix::Identity();
    block(covariance, ErrorState::kLegScale, ErrorState::kLegScale) *= 100.0;
    stamp_ += kPeriod;
    return gate_.inflation(stamp_, measurement, covariance);
  }

  /// The last factor of `duration` of samples off by `residual` [m/s].
  std::optional<double> last(double residual, Duration duration) {
    std::optional<double> factor;
    for (Time t = 0; t < duration; t += kPeriod) factor = next(residual);
    return factor;
  }

 private:
  LegGate gate_{kRate};
  Time stamp_ = 0;
};

TEST(LegGate, InflatesBeforeItRejects) {
  EXPECT_EQ(gate_inflation(0.99 * kLegGate), 1.0);
  EXPECT_NEAR(gate_inflation(3.0 * kLegGate).value(), 3.0, 1e-12);
  EXPECT_FALSE(gate_inflation(1.01 * kMaxVarianceGrowth * kLegGate).has_value());
  EXPECT_FALSE(gate_inflation(std::numeric_limits<double>::quiet_NaN()).has_value());
}

// Deviation of a single sample's innovation: 5 cm/s, so that 4 and 8 of them limit the gate. The
// scale of the legs, uncertain by 0.3, would hide all of it.
TEST(LegGate, JudgesASingleSampleByVelocityAndNoise) {
  GatedWalk walk;
  EXPECT_EQ(walk.next(0.19), 1.0);
  EXPECT_NEAR(walk.next(0.3).value(), 0.3 * 0.3 / (0.05 * 0.05 * kLegGate), 1e-9);
  EXPECT_FALSE(walk.next(-0.42).has_value());
}

TEST(LegGate, PassesATouchdownWeakenedAndStopsASlip) {
  GatedWalk walk;
  for (const double residual : {0.01, 0.3, 0.35, -0.3, -0.35, 0.01}) {
    EXPECT_TRUE(walk.next(residual).has_value()) << residual;
  }
  EXPECT_FALSE(walk.last(1.5, 200 * kMillisecond).has_value());
  EXPECT_EQ(walk.next(0.01), 1.0);
}

TEST(LegGate, AcceptsAnInnovationThatLastsLongerThanASlip) {
  GatedWalk walk;
  EXPECT_FALSE(walk.last(0.5, 400 * kMillisecond).has_value());
  EXPECT_EQ(walk.last(0.5, 200 * kMillisecond), 1.0);
  EXPECT_EQ(walk.next(0.01), 1.0);
  EXPECT_FALSE(walk.next(0.5).has_value()) << "a new one";
}

}  // namespace
}  // namespace aims
