// SPDX-License-Identifier: BSD-3-Clause
#include "sim/sensors/sampling.hpp"

#include <gtest/gtest.h>

namespace aims {
namespace {

TEST(Sampling, CountsThePhysicsStepsOfAPeriod) {
  EXPECT_EQ(steps_per_sample("imu.rate", 50.0, 2'500'000).value(), 8);
  EXPECT_EQ(steps_per_sample("leg_odometry.rate", 200.0, 2'500'000).value(), 2);
}

TEST(Sampling, RefusesAPeriodThatIsNoWholeNumberOfSteps) {
  const auto steps = steps_per_sample("leg_odometry.rate", 200.0, 2'000'000);
  ASSERT_FALSE(steps);
  EXPECT_NE(steps.error().message.find("leg_odometry.rate"), std::string::npos);
  EXPECT_FALSE(steps_per_sample("imu.rate", 1000.0, 2'500'000));
}

}  // namespace
}  // namespace aims
