// SPDX-License-Identifier: BSD-3-Clause
#include "tests/independent/legs.hpp"

#include <cmath>

#include "core/random.hpp"

namespace aims::independent {
namespace {

/// Loses single packets and bursts of geometric length.
class PacketLoss {
 public:
  explicit PacketLoss(const LegOptions& options)
      : options_(options), random_(rng(options.seed, "independent.legs.loss")) {}

  bool loses_next() {
    const double leave = 1.0 / options_.burst_length;
    const double enter = leave * options_.burst_loss / (1.0 - options_.burst_loss);
    in_burst_ = in_burst_ ? !random_.chance(leave) : random_.chance(enter);
    return random_.chance(options_.single_loss) || in_burst_;
  }

 private:
  LegOptions options_;
  RandomStream random_;
  bool in_burst_ = false;
};

/// Error of the velocity: white, and constant over each half stride [m/s].
class VelocityNoise {
 public:
  explicit VelocityNoise(const LegOptions& options)
      : options_(options), random_(rng(options.seed, "independent.legs.velocity")) {}

  Eigen::Vector3d at(const Walk& walk, double t) {
    const double activity = walk.activity(t);
    const auto step = static_cast<int>(std::floor(2.0 * walk.strides(t)));
    if (step != step_) of_step_ = options_.step_noise * random_.normal3();
    step_ = step;
    return activity * of_step_ +
           (options_.standing_noise + activity * options_.white_noise) * random_.normal3();
  }

 private:
  LegOptions options_;
  RandomStream random_;
  int step_ = 0;
  Eigen::Vector3d of_step_ = Eigen::Vector3d::Zero();
};

}  // namespace

std::vector<LegOdometrySample> sample_legs(const Walk& walk, const Pose& T_body_base,
                                           const LegOptions& options) {
  RandomStream random = rng(options.seed, "independent.legs");
  PacketLoss loss(options);
  VelocityNoise noise(options);
  const double drift = options.heading_drift * random.normal();
  const double interval = 1.0 / options.rate_hz;
  const Eigen::Quaterniond to_base = T_body_base.rotation.conjugate();
  Pose T_odom_base;
  T_odom_base.rotation = (walk.pose(0.0) * T_body_base).rotation;
  std::vector<LegOdometrySample> samples;
  for (int i = 1; i <= static_cast<int>(walk.duration() * options.rate_hz); ++i) {
    const double t = i * interval;
    const BodyState body = walk.state(t);
    const Eigen::Vector3d in_body = body.T_world_body.rotation.conjugate() * body.velocity +
                                    body.angular_velocity.cross(T_body_base.translation);
    LegOdometrySample sample;
    sample.stamp = from_seconds(t);
    sample.linear_velocity = options.scale * (to_base * in_body) + noise.at(walk, t);
    sample.angular_velocity = to_base * body.angular_velocity +
                              options.turn_noise * random.normal3() +
                              drift * Eigen::Vector3d::UnitZ();
    // The robot's own attitude: roll and pitch by gravity, a drifting heading.
    T_odom_base.rotation = yaw_rotation(drift * t) * (body.T_world_body * T_body_base).rotation;
    T_odom_base.translation += T_odom_base.rotation * sample.linear_velocity * interval;
    sample.T_odom_base = T_odom_base;
    if (!loss.loses_next()) samples.push_back(sample);
  }
  return samples;
}

}  // namespace aims::independent
