// SPDX-License-Identifier: BSD-3-Clause
// The zero-velocity detector on simulated measurements, compared with the true motion.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "estimator/legs/zero_velocity.hpp"
#include "tests/estimator/simulated_sequence.hpp"

namespace aims {
namespace {

using testing::SimulatedSequence;

/// Samples of one kind, and how many of them were detected as standing.
struct Fraction {
  int samples = 0;
  int standing = 0;
  void add(bool stands) {
    ++samples;
    standing += stands ? 1 : 0;
  }
  double value() const { return static_cast<double>(standing) / samples; }
};

struct Outcome {
  Fraction still;    ///< at rest for the last half second
  Fraction walking;  ///< moves or turns within a quarter of a second before and after
  Fraction swaying;  ///< faster than 5 cm/s at this time
};

/// Out and back over 2.5 m, with longer stops; the LiDAR is minimal.
SimulationConfig out_and_back() {
  SimulationConfig config = testing::straight_sequence(4.0, 16);
  config.route.points = {{"a", 0.0, 0.0}, {"b", 2.5, 0.0}, {"a", 0.0, 0.0}};
  config.route.stand_at_points = 2.0;
  config.route.stand_after = 1.5;
  return config;
}

/// The truth `before` and `after` a time, or at the ends of the sequence.
std::pair<const TruthSample*, const TruthSample*> around(const Truth& truth, Time stamp,
                                                         Duration before, Duration after) {
  const auto at = [&truth](Time wanted) {
    const auto found =
        std::lower_bound(truth.samples.begin(), truth.samples.end(), wanted,
                         [](const TruthSample& sample, Time time) { return sample.stamp < time; });
    return found == truth.samples.end() ? &truth.samples.back() : &*found;
  };
  return {at(stamp - before), at(stamp + after)};
}

bool is_still(const Truth& truth, Time stamp) {
  const auto [from, to] = around(truth, stamp, kSecond / 2, 0);
  return stamp >= kSecond / 2 && std::all_of(from, to + 1, [](const TruthSample& sample) {
           return sample.velocity.norm() < 0.02 && sample.angular_velocity.norm() < 0.03;
         });
}

bool is_walking(const Truth& truth, Time stamp) {
  const auto [from, to] = around(truth, stamp, kSecond / 4, kSecond / 4);
  const Pose moved = from->T_world_body.inverse() * to->T_world_body;
  return moved.translation.norm() > 0.1 || std::abs(yaw_of(moved.rotation)) > 0.15;
}

Outcome observe(const SimulatedSequence& sequence) {
  ZeroVelocityDetector detector;
  std::vector<ImuSample> imu;
  Outcome outcome;
  for (const Delivery& delivery : sequence.deliveries) {
    if (const auto* sample = std::get_if<ImuSample>(&delivery.measurement)) {
      imu.push_back(*sample);
      std::erase_if(imu, [&](const ImuSample& s) { return s.stamp < sample->stamp - kSecond; });
    }
    const auto* legs = std::get_if<LegOdometrySample>(&delivery.measurement);
    if (legs == nullptr) continue;
    const TruthSample& now = *around(sequence.truth, legs->stamp, 0, 0).first;
    const bool stands = detector.update(*legs, imu, now.gyro_bias);
    if (is_still(sequence.truth, legs->stamp)) outcome.still.add(stands);
    if (is_walking(sequence.truth, legs->stamp)) outcome.walking.add(stands);
    if (now.velocity.norm() > 0.05) outcome.swaying.add(stands);
  }
  return outcome;
}

TEST(ZeroVelocitySimulation, DetectsStandingAndNotWalkingOrTurning) {
  for (const std::uint64_t seed : {1, 2}) {
    const Outcome outcome = observe(testing::simulate(out_and_back(), seed));
    ASSERT_GT(outcome.still.samples, 800) << "seed " << seed;
    ASSERT_GT(outcome.walking.samples, 1500) << "seed " << seed;
    EXPECT_GT(outcome.still.value(), 0.9) << "seed " << seed;
    EXPECT_LT(outcome.walking.value(), 0.001) << "seed " << seed;
  }
}

TEST(ZeroVelocitySimulation, DetectsAPushedRobotBetweenPushesOnly) {
  SimulationConfig config = out_and_back();
  config.route.stand_before = 8.0;
  config.push = {.count = 8, .force = 40.0, .end = 8.0};
  const SimulatedSequence sequence = testing::simulate(config, 1);
  ASSERT_NE(sequence.truth.walk.end, WalkEnd::kFell);
  const Outcome outcome = observe(sequence);
  EXPECT_GT(outcome.still.value(), 0.85);
  EXPECT_LT(outcome.swaying.value(), 0.01);
}

}  // namespace
}  // namespace aims
