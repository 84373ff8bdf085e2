// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/filter/initialization.hpp"

#include <cmath>

namespace aims {
namespace {

/// Fewer standing samples than this say nothing about biases.
constexpr int kFewestSamples = 5;

/// Variance of a state that is taken as known, and yet leaves the covariance invertible.
constexpr double kKnown = 1e-16;

struct Standing {
  Eigen::Vector3d rate = Eigen::Vector3d::Zero();   ///< mean [rad/s]
  Eigen::Vector3d force = Eigen::Vector3d::Zero();  ///< mean [m/s^2]
  Time end = 0;                                     ///< of the last sample averaged
  int count = 0;
  bool moved = false;
};

/// Whether the sample can be one of a robot that stands still.
bool is_still(const ImuSample& sample, const InitializationConfig& config, double gravity) {
  return sample.angular_velocity.norm() <= config.still_rate &&
         std::abs(sample.specific_force.norm() - gravity) <= config.still_force;
}

/// Means over the standing samples later than `settle` [s] after the first, up to the end of the
/// stand or the first motion after settling.
Standing average_standing(const std::deque<ImuSample>& samples, double settle,
                          const InitializationConfig& config, double gravity) {
  Standing standing;
  const Time first = samples.front().stamp;
  for (const ImuSample& sample : samples) {
    if (sample.stamp - first > from_seconds(config.duration)) break;
    if (sample.stamp - first < from_seconds(settle)) continue;
    standing.moved = !is_still(sample, config, gravity);
    if (standing.moved) break;
    standing.rate += sample.angular_velocity;
    standing.force += sample.specific_force;
    standing.end = sample.stamp;
    ++standing.count;
  }
  if (standing.count > 0) {
    standing.rate /= standing.count;
    standing.force /= standing.count;
  }
  return standing;
}

/// The stretch of quiet samples that begins at `begin`: each keeps close to the mean of those
/// before it, and all together to what a body at rest feels.
Standing quiet_from(const std::deque<ImuSample>& samples, std::size_t begin,
                    const InitializationConfig& config, const StartConfig& quiet, double gravity) {
  Standing stretch;
  for (std::size_t i = begin; i < samples.size(); ++i) {
    const ImuSample& sample = samples[i];
    const bool near =
        stretch.count == 0 || ((sample.angular_velocity - stretch.rate).norm() <= quiet.rate &&
                               (sample.specific_force - stretch.force).norm() <= quiet.force);
    stretch.moved = !near || !is_still(sample, config, gravity);
    if (stretch.moved) break;
    ++stretch.count;
    stretch.rate += (sample.angular_velocity - stretch.rate) / stretch.count;
    stretch.force += (sample.specific_force - stretch.force) / stretch.count;
    stretch.end = sample.stamp;
  }
  return stretch;
}

/// Mean specific force of all samples [m/s^2]: what a gait adds to gravity averages out.
Eigen::Vector3d mean_force(const std::deque<ImuSample>& samples) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const ImuSample& sample : samples) sum += sample.specific_force;
  return sum / static_cast<double>(samples.size());
}

/// Roll and pitch that turn the mean specific force upward, yaw 0.
Eigen::Quaterniond level(const Eigen::Vector3d& force) {
  const Eigen::Quaterniond tilt =
      Eigen::Quaterniond::FromTwoVectors(force.normalized(), Eigen::Vector3d::UnitZ());
  return (yaw_rotation(-yaw_of(tilt)) * tilt).normalized();
}

ErrorMatrix initial_covariance(const InitializationConfig& config, bool stood_still,
                               bool rate_known) {
  using E = ErrorState;
  // What the start does not tell has ten times the deviation, and the velocity may be any.
  const auto variance = [](double sigma, bool told) {
    return Eigen::Matrix3d((told ? 1.0 : 100.0) * sigma * sigma * Eigen::Matrix3d::Identity());
  };
  ErrorMatrix P = ErrorMatrix::Zero();
  block(P, E::kRotation, E::kRotation) = variance(config.sigma_tilt, stood_still);
  block(P, E::kRotation, E::kRotation)(2, 2) = config.sigma_yaw * config.sigma_yaw;
  block(P, E::kPosition, E::kPosition) =
      Eigen::Matrix3d::Identity() * (config.sigma_position * config.sigma_position);
  const double velocity = stood_still ? config.sigma_velocity : config.sigma_velocity_moving;
  block(P, E::kVelocity, E::kVelocity) = Eigen::Matrix3d::Identity() * (velocity * velocity);
  block(P, E::kGyroBias, E::kGyroBias) = variance(config.sigma_gyro_bias, rate_known);
  block(P, E::kAccelerometerBias, E::kAccelerometerBias) =
      variance(config.sigma_accelerometer_bias, stood_still);
  // Members that learn the states of the legs open them.
  block(P, E::kLegScale, E::kLegScale) = Eigen::Matrix3d::Identity() * kKnown;
  block(P, E::kLegBias, E::kLegBias) = Eigen::Matrix3d::Identity() * kKnown;
  return P;
}

/// The belief at the end of the stand, or at the newest sample where none was found. Without
/// `rate_known` the mean rate is not taken for the bias: the body may sway.
InitialBelief begin_with(const std::deque<ImuSample>& samples, const Standing& standing,
                         bool enough, bool rate_known, const InitializationConfig& config) {
  InitialBelief initial;
  initial.stamp = enough ? standing.end : samples.back().stamp;
  initial.stood_still = enough;
  initial.belief.state.rotation = level(enough ? standing.force : mean_force(samples));
  if (rate_known) initial.belief.state.gyro_bias = standing.rate;
  initial.belief.covariance = initial_covariance(config, enough, rate_known);
  return initial;
}

}  // namespace

std::optional<InitialBelief> initialize(const std::deque<ImuSample>& samples,
                                        const InitializationConfig& config, double gravity) {
  if (samples.empty()) return std::nullopt;
  Standing standing = average_standing(samples, config.settle, config, gravity);
  const Duration span = samples.back().stamp - samples.front().stamp;
  if (span < from_seconds(config.duration) && !standing.moved) return std::nullopt;
  if (standing.count < kFewestSamples) standing = average_standing(samples, 0.0, config, gravity);
  const bool enough = standing.count >= kFewestSamples;
  return begin_with(samples, standing, enough, enough, config);
}

std::optional<InitialBelief> initialize_quietly(const std::deque<ImuSample>& samples,
                                                const InitializationConfig& config,
                                                const StartConfig& quiet, double gravity) {
  if (samples.empty()) return std::nullopt;
  const Duration span = samples.back().stamp - samples.front().stamp;
  if (span < from_seconds(config.settle)) return std::nullopt;
  Standing best;
  double longest = -1.0;
  std::size_t best_begin = 0;
  for (std::size_t begin = 0; begin < samples.size(); ++begin) {
    const Time from = samples[begin].stamp;
    if (samples.back().stamp - from < from_seconds(longest)) break;
    const Standing stretch = quiet_from(samples, begin, config, quiet, gravity);
    // The last of equally long stretches: the longer the robot has stood, the better it stands.
    if (stretch.count == 0 || to_seconds(stretch.end - from) < longest) continue;
    longest = to_seconds(stretch.end - from);
    best = stretch;
    best_begin = begin;
  }
  // Of a long stretch the end alone: before it the robot takes its stance.
  const Time averaged = best.end - from_seconds(config.duration - config.settle);
  while (best.count > 0 && samples[best_begin].stamp < averaged) ++best_begin;
  if (best.count > 0) best = quiet_from(samples, best_begin, config, quiet, gravity);
  const bool stands = best.count > 0 && !best.moved;
  if (span < from_seconds(config.duration) && stands) return std::nullopt;
  const bool enough = best.count >= kFewestSamples && longest >= quiet.shortest;
  const bool rate_known = enough && longest >= quiet.shortest_for_rate;
  return begin_with(samples, best, enough, rate_known, config);
}

}  // namespace aims
