// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/filter/static_initialization.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace aims {
namespace {

constexpr double kMaxDuration = 60.0;  ///< bound on configured durations [s]

/// Part of the standing start that is not averaged: the robot settles [-].
constexpr double kSettling = 0.5;

/// A faster turn [rad/s] and a larger deviation of the specific force from gravity [m/s^2] are
/// motion.
constexpr double kMaxRate = 0.15;
constexpr double kMaxForceFromGravity = 0.8;

/// A larger deviation of the specific force from its mean ends a static interval, beyond white
/// noise [m/s^2].
constexpr double kMaxForceDeviation = 0.1;

/// Shortest intervals that give the tilt and the gyro bias [s]: 5 mrad of sway in 0.3 s are 17
/// mrad/s.
constexpr double kMinDuration = 0.2;
constexpr double kMinDurationGyroBias = 0.9;

/// The odometry frame defines yaw [rad] and position [m].
constexpr double kSigmaYaw = 1e-4;
constexpr double kSigmaPosition = 1e-4;

/// Initial velocity of a robot that stands, and of one that moves [m/s].
constexpr double kSigmaVelocity = 2e-2;
constexpr double kSigmaVelocityMoving = 1.0;

/// Fewer standing samples than this give no biases.
constexpr int kMinSamples = 5;

/// Largest deviation of the rate from its mean that is not motion, beyond white noise [rad/s].
constexpr double kMaxRateDeviation = 0.03;

/// Variance of a state that is fixed; above zero so that the covariance stays invertible.
constexpr double kFixedVariance = 1e-16;

double variance_of(double sigma) { return sigma * sigma; }

/// Deviation per axis of a signal's white part, from the median square of its second differences,
/// 6 s^2 times a chi-square variable of 3 dof: a push or a step leaves the median as it is.
template <class Signal>
double white_deviation(std::span<const ImuSample> samples, Signal&& signal) {
  if (samples.size() < 3) return 0.0;
  std::vector<double> squares;
  for (std::size_t i = 2; i < samples.size(); ++i) {
    squares.push_back(
        (signal(samples[i]) - 2.0 * signal(samples[i - 1]) + signal(samples[i - 2])).squaredNorm());
  }
  const auto middle = squares.begin() + static_cast<std::ptrdiff_t>(squares.size() / 2);
  std::nth_element(squares.begin(), middle, squares.end());
  constexpr double kMedianOfChiSquare = 2.366;
  return std::sqrt(*middle / (6.0 * kMedianOfChiSquare));
}

/// White noise of the samples: what they show while nothing moves.
WhiteDeviation sample_noise(std::span<const ImuSample> samples) {
  return {white_deviation(samples,
                          [](const ImuSample& s) -> Eigen::Vector3d { return s.angular_velocity; }),
          white_deviation(samples,
                          [](const ImuSample& s) -> Eigen::Vector3d { return s.specific_force; })};
}

/// Largest norm that white noise of deviation 1 per axis reaches: 99.99 %.
constexpr double kLargestNoise = 4.6;

/// Averages over an interval without motion.
struct StaticInterval {
  Eigen::Vector3d rate = Eigen::Vector3d::Zero();   ///< mean [rad/s]
  Eigen::Vector3d force = Eigen::Vector3d::Zero();  ///< mean [m/s^2]
  Time end = 0;                                     ///< of the last sample averaged
  int count = 0;
  bool moved = false;  ///< motion ended it
};

/// Whether the sample is consistent with a robot that stands still.
bool is_still(const ImuSample& sample, double gravity) {
  return sample.angular_velocity.norm() <= kMaxRate &&
         std::abs(sample.specific_force.norm() - gravity) <= kMaxForceFromGravity;
}

/// Means from `settling_time` [s] after the first sample to the end of the standing start or the
/// first motion.
StaticInterval average_start(std::span<const ImuSample> samples, double settling_time,
                             const InitializationConfig& config, double gravity) {
  StaticInterval interval;
  const Time first = samples.front().stamp;
  for (const ImuSample& sample : samples) {
    if (sample.stamp - first > from_seconds(config.duration)) break;
    if (sample.stamp - first < from_seconds(settling_time)) continue;
    interval.moved = !is_still(sample, gravity);
    if (interval.moved) break;
    interval.rate += sample.angular_velocity;
    interval.force += sample.specific_force;
    interval.end = sample.stamp;
    ++interval.count;
  }
  if (interval.count > 0) {
    interval.rate /= interval.count;
    interval.force /= interval.count;
  }
  return interval;
}

/// The interval from sample `begin` on in which each sample stays close to the mean of those before
/// it and none shows motion.
StaticInterval static_interval_from(std::span<const ImuSample> samples, std::size_t begin,
                                    const WhiteDeviation& noise, double gravity) {
  const double max_rate_deviation = kMaxRateDeviation + kLargestNoise * noise.rate;
  const double max_force_deviation = kMaxForceDeviation + kLargestNoise * noise.force;
  StaticInterval interval;
  for (std::size_t i = begin; i < samples.size(); ++i) {
    const ImuSample& sample = samples[i];
    const double rate_deviation = (sample.angular_velocity - interval.rate).norm();
    const double force_deviation = (sample.specific_force - interval.force).norm();
    const bool close = interval.count == 0 || (rate_deviation <= max_rate_deviation &&
                                               force_deviation <= max_force_deviation);
    interval.moved = !close || !is_still(sample, gravity);
    if (interval.moved) break;
    ++interval.count;
    interval.rate += (sample.angular_velocity - interval.rate) / interval.count;
    interval.force += (sample.specific_force - interval.force) / interval.count;
    interval.end = sample.stamp;
  }
  return interval;
}

/// An interval and where it begins.
struct LongestInterval {
  StaticInterval interval;
  std::size_t begin = 0;
  double duration = -1.0;  ///< [s]
};

/// The longest static interval; of equally long ones the last, since the robot settles with time.
LongestInterval longest_static_interval(std::span<const ImuSample> samples,
                                        const WhiteDeviation& noise, double gravity) {
  LongestInterval longest;
  for (std::size_t begin = 0; begin < samples.size(); ++begin) {
    const Time from = samples[begin].stamp;
    if (samples.back().stamp - from < from_seconds(longest.duration)) break;
    const StaticInterval found = static_interval_from(samples, begin, noise, gravity);
    if (found.count == 0 || to_seconds(found.end - from) < longest.duration) continue;
    longest = {found, begin, to_seconds(found.end - from)};
  }
  return longest;
}

/// Mean specific force of all samples [m/s^2]; the accelerations of a gait average out.
Eigen::Vector3d mean_force(std::span<const ImuSample> samples) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const ImuSample& sample : samples) sum += sample.specific_force;
  return sum / static_cast<double>(samples.size());
}

/// Attitude with yaw 0 in which the mean specific force points upward.
Eigen::Quaterniond level(const Eigen::Vector3d& force) {
  const Eigen::Quaterniond tilt =
      Eigen::Quaterniond::FromTwoVectors(force.normalized(), Eigen::Vector3d::UnitZ());
  return (yaw_rotation(-yaw_of(tilt)) * tilt).normalized();
}

/// A tilt from the mean specific force g up x d_rotation + b + error = 0 in the horizontal, with
/// the accelerometer bias b: d_rotation = up x (b + error) / g; `up` in body axes, g = `gravity`.
void set_tilt_and_bias(const InitializationConfig& config, const Eigen::Vector3d& up,
                       double sigma_force, double gravity, ErrorMatrix& P) {
  using E = ErrorState;
  const double bias = variance_of(config.sigma_accelerometer_bias);
  const double tilt = (bias + variance_of(sigma_force)) / (gravity * gravity);
  const Eigen::Matrix3d vertical = up * up.transpose();
  block(P, E::kRotation, E::kRotation) =
      tilt * (Eigen::Matrix3d::Identity() - vertical) + variance_of(kSigmaYaw) * vertical;
  block(P, E::kRotation, E::kAccelerometerBias) = bias / gravity * hat(up);
  block(P, E::kAccelerometerBias, E::kRotation) = bias / gravity * hat(up).transpose();
  block(P, E::kAccelerometerBias, E::kAccelerometerBias) = bias * Eigen::Matrix3d::Identity();
}

/// An unmeasured gyro bias gets ten times the configured deviation, an unmeasured velocity its own.
ErrorMatrix initial_covariance(const InitializationConfig& config, double sigma_force,
                               const Eigen::Vector3d& up, bool stood_still, bool gyro_bias_measured,
                               double gravity) {
  using E = ErrorState;
  const Eigen::Matrix3d I = Eigen::Matrix3d::Identity();
  ErrorMatrix P = ErrorMatrix::Zero();
  set_tilt_and_bias(config, up, sigma_force, gravity, P);
  block(P, E::kPosition, E::kPosition) = I * variance_of(kSigmaPosition);
  block(P, E::kVelocity, E::kVelocity) =
      I * variance_of(stood_still ? kSigmaVelocity : kSigmaVelocityMoving);
  block(P, E::kGyroBias, E::kGyroBias) =
      I * variance_of((gyro_bias_measured ? 1.0 : 10.0) * config.sigma_gyro_bias);
  // Raised by open_leg_states() and open_calibration() where they are estimated.
  block(P, E::kLegScale, E::kLegScale) = I * kFixedVariance;
  block(P, E::kLegBias, E::kLegBias) = I * kFixedVariance;
  block(P, E::kMount, E::kMount) = I * kFixedVariance;
  P(E::kDelay, E::kDelay) = kFixedVariance;
  return P;
}

/// The means from sample `begin` on to the end of an interval that is known to be static: by the
/// mean of its first samples alone noise would pass for motion.
StaticInterval averaged_from(std::span<const ImuSample> samples, std::size_t begin,
                             const StaticInterval& known) {
  StaticInterval interval;
  interval.end = known.end;
  interval.moved = known.moved;
  for (std::size_t i = begin; i < samples.size() && samples[i].stamp <= known.end; ++i) {
    ++interval.count;
    interval.rate += (samples[i].angular_velocity - interval.rate) / interval.count;
    interval.force += (samples[i].specific_force - interval.force) / interval.count;
  }
  return interval;
}

/// The belief at the end of `interval`, or at the newest sample when it is too short for a tilt.
/// The mean rate is the gyro bias only with `gyro_bias_measured`: otherwise the body may sway.
InitialBelief begin_with(std::span<const ImuSample> samples, const StaticInterval& interval,
                         bool enough, bool gyro_bias_measured, const WhiteDeviation& noise,
                         InitializationConfig config, double gravity) {
  // The mean of white noise adds to the errors of the means.
  const double root_count = std::sqrt(std::max(1, interval.count));
  const double sigma_force =
      enough ? std::hypot(kSigmaMeanForce, noise.force / root_count) : kSigmaMeanForceMoving;
  config.sigma_gyro_bias = std::hypot(config.sigma_gyro_bias, noise.rate / root_count);
  InitialBelief initial;
  initial.stamp = enough ? interval.end : samples.back().stamp;
  initial.stood_still = enough;
  initial.belief.state.rotation = level(enough ? interval.force : mean_force(samples));
  if (gyro_bias_measured) initial.belief.state.gyro_bias = interval.rate;
  const Eigen::Vector3d up = initial.belief.state.rotation.conjugate() * Eigen::Vector3d::UnitZ();
  initial.belief.covariance =
      initial_covariance(config, sigma_force, up, enough, gyro_bias_measured, gravity);
  return initial;
}

}  // namespace

void describe(Fields& f, InitializationConfig& c) {
  f.number(
      "duration", c.duration,
      {"s", in_range(0.1, kMaxDuration), "standing time at the start; its second half is averaged",
       "chosen: a robot that has risen stands for seconds"});
  f.number("sigma_gyro_bias", c.sigma_gyro_bias,
           {"rad/s", positive_up_to(1e4), "gyro bias after averaging",
            "chosen: noise and sway, averaged for a second"});
  f.number(
      "sigma_accelerometer_bias", c.sigma_accelerometer_bias,
      {"m/s^2", positive_up_to(1e5), "accelerometer bias, inseparable from tilt while standing",
       "MEMS: 50 mg as two sigma in the ICM-20948"});
}

void describe(Fields& f, StaticInitializationConfig& c) {
  f.flag("enabled", c.enabled,
         {"", any(), "initialize from the longest undisturbed interval of the start"});
}

std::optional<InitialBelief> initialize(std::span<const ImuSample> samples,
                                        const InitializationConfig& config, double gravity) {
  if (samples.empty()) return std::nullopt;
  StaticInterval start = average_start(samples, kSettling * config.duration, config, gravity);
  const Duration span = samples.back().stamp - samples.front().stamp;
  if (span < from_seconds(config.duration) && !start.moved) return std::nullopt;
  if (start.count < kMinSamples) start = average_start(samples, 0.0, config, gravity);
  const bool enough = start.count >= kMinSamples;
  return begin_with(samples, start, enough, enough, sample_noise(samples), config, gravity);
}

std::optional<InitialBelief> initialize_static(std::span<const ImuSample> samples,
                                               const InitializationConfig& config, double gravity) {
  if (samples.empty()) return std::nullopt;
  const Duration span = samples.back().stamp - samples.front().stamp;
  if (span < from_seconds(kSettling * config.duration)) return std::nullopt;
  const WhiteDeviation noise = sample_noise(samples);
  auto [best, begin, duration] = longest_static_interval(samples, noise, gravity);
  if (best.count > 0) {
    // Only the end of a long interval is averaged: before it the robot settles.
    const Time averaged = best.end - from_seconds((1.0 - kSettling) * config.duration);
    while (samples[begin].stamp < averaged) ++begin;
    best = averaged_from(samples, begin, best);
  }
  const bool still_standing = best.count > 0 && !best.moved;
  if (span < from_seconds(config.duration) && still_standing) return std::nullopt;
  const bool enough = best.count >= kMinSamples && duration >= kMinDuration;
  const bool gyro_bias_measured = enough && duration >= kMinDurationGyroBias;
  return begin_with(samples, best, enough, gyro_bias_measured, noise, config, gravity);
}

}  // namespace aims
