// SPDX-License-Identifier: BSD-3-Clause
#include "tests/independent/inertial.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/random.hpp"

namespace aims::independent {
namespace {

constexpr double kDecay = 0.5;     ///< after which a footfall's oscillation counts no more [s]
constexpr double kJitter = 0.012;  ///< deviation of a footfall's time [s]

struct Mode {
  double frequency_hz;
  double damping;   ///< ratio to critical
  double strength;  ///< relative
};
constexpr Mode kModeTable[] = {
    {18.3, 0.09, 0.7}, {27.1, 0.07, 1.0}, {41.7, 0.06, 0.9}, {63.4, 0.05, 0.8}, {88.6, 0.04, 0.6}};

/// Derivative of the damped oscillation exp(-decay t) sin(omega t), relative to omega.
double oscillation(const Mode& mode, double t) {
  const double natural = 2.0 * std::numbers::pi * mode.frequency_hz;
  const double decay = mode.damping * natural;
  const double omega = natural * std::sqrt(1.0 - mode.damping * mode.damping);
  return std::exp(-decay * t) * (std::cos(omega * t) - decay / omega * std::sin(omega * t));
}

}  // namespace

Vibration::Vibration(const Walk& walk, double force_deviation, double rate_deviation,
                     std::uint64_t seed) {
  static_assert(std::size(kModeTable) == kModes);
  RandomStream random = rng(seed, "independent.vibration");
  const int count = static_cast<int>(2.0 * walk.strides(walk.end()));
  for (int i = 1; i < count; ++i) {
    // The two feet of a diagonal pair land shortly after each other.
    const double nominal = walk.start() + 0.5 * i / kStrideHz + 0.02 * random.uniform();
    for (const double delay : {0.0, random.uniform(0.004, 0.03)}) {
      Footfall footfall;
      footfall.time = nominal + delay + kJitter * random.normal();
      const double force = std::exp(0.35 * random.normal()) * walk.activity(nominal);
      for (double& each : footfall.strength.reshaped()) each = force * random.normal();
      footfalls_.push_back(footfall);
    }
  }
  std::ranges::sort(footfalls_, {}, &Footfall::time);

  Vector6d squares = Vector6d::Zero();
  int samples = 0;
  for (double t = walk.start(); t < walk.end(); t += 1.0e-3, ++samples) {
    squares += at(t).cwiseAbs2();
  }
  const Vector6d deviation = (squares / std::max(samples, 1)).cwiseSqrt();
  scale_.head<3>() = rate_deviation * deviation.head<3>().cwiseInverse();
  scale_.tail<3>() = force_deviation * deviation.tail<3>().cwiseInverse();
}

Vector6d Vibration::at(double t) const {
  Vector6d sum = Vector6d::Zero();
  auto footfall = std::ranges::lower_bound(footfalls_, t - kDecay, {}, &Footfall::time);
  for (; footfall != footfalls_.end() && footfall->time <= t; ++footfall) {
    for (int mode = 0; mode < kModes; ++mode) {
      const double value = oscillation(kModeTable[mode], t - footfall->time);
      sum += kModeTable[mode].strength * value * footfall->strength.col(mode);
    }
  }
  return scale_.cwiseProduct(sum);
}

InertialOptions ideal_inertial(double rate_hz) {
  InertialOptions options;
  options.rate_hz = rate_hz;
  for (double* each : {&options.force_vibration, &options.rate_vibration, &options.gyro_noise,
                       &options.force_noise, &options.gyro_bias, &options.force_bias,
                       &options.gyro_walk, &options.force_walk}) {
    *each = 0.0;
  }
  return options;
}

std::vector<ImuSample> sample_inertial(const Walk& walk, const InertialOptions& options) {
  const Vibration vibration(walk, options.force_vibration, options.rate_vibration, options.seed);
  RandomStream random = rng(options.seed, "independent.imu");
  const double interval = 1.0 / options.rate_hz;
  const double root_bandwidth = std::sqrt(options.noise_bandwidth_hz);
  Eigen::Vector3d gyro_bias = options.gyro_bias * random.normal3();
  Eigen::Vector3d force_bias = options.force_bias * random.normal3();
  std::vector<ImuSample> samples;
  const auto count = static_cast<int>(walk.duration() * options.rate_hz);
  for (int i = 1; i <= count; ++i) {
    const double t = i * interval;
    const BodyState truth = walk.state(t);
    const Vector6d shaking = vibration.at(t);
    gyro_bias += options.gyro_walk * std::sqrt(interval) * random.normal3();
    force_bias += options.force_walk * std::sqrt(interval) * random.normal3();
    ImuSample sample;
    sample.stamp = from_seconds(t);
    sample.angular_velocity = truth.angular_velocity + shaking.head<3>() + gyro_bias +
                              options.gyro_noise * root_bandwidth * random.normal3();
    sample.specific_force = truth.specific_force + shaking.tail<3>() + force_bias +
                            options.force_noise * root_bandwidth * random.normal3();
    samples.push_back(sample);
  }
  return samples;
}

}  // namespace aims::independent
