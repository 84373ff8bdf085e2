// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/inspection/static_interval.hpp"

#include <algorithm>
#include <cmath>

namespace aims {
namespace {

constexpr double kMaxRate = 0.1;            ///< mean rate [rad/s]
constexpr double kMaxRateDeviation = 0.03;  ///< standard deviation, any axis [rad/s]
constexpr double kMaxForceDeviation = 0.3;  ///< standard deviation, any axis [m/s^2]
constexpr int kMinSamples = 10;             ///< of a window

Eigen::Vector3d deviation(const Eigen::Vector3d& sum, const Eigen::Vector3d& squares, int count) {
  const Eigen::Vector3d mean = sum / count;
  return (squares / count - mean.cwiseProduct(mean)).cwiseMax(0.0).cwiseSqrt();
}

}  // namespace

void StaticIntervalFinder::Sums::add(const ImuSample& sample, const ImuSample& origin) {
  if (samples == 0) begin = sample.stamp;
  end = sample.stamp;
  ++samples;
  const Eigen::Vector3d rate_off = sample.angular_velocity - origin.angular_velocity;
  const Eigen::Vector3d force_off = sample.specific_force - origin.specific_force;
  rate += rate_off;
  rate_squares += rate_off.cwiseProduct(rate_off);
  force += force_off;
  force_squares += force_off.cwiseProduct(force_off);
  const double since = to_seconds(sample.stamp - begin);
  time += since;
  time_squares += since * since;
  force_by_time += since * force_off;
}

void StaticIntervalFinder::Sums::add(const Sums& other) {
  if (samples == 0) begin = other.begin;
  end = other.end;
  samples += other.samples;
  rate += other.rate;
  rate_squares += other.rate_squares;
  force += other.force;
  force_squares += other.force_squares;
}

/// Whether the specific force turns as the mean rate says: then it is no bias.
bool StaticIntervalFinder::turns(const Sums& window) const {
  constexpr double kClear = 3.0;  // times the standard deviation of the trend
  const int count = window.samples;
  const double spread = window.time_squares - window.time * window.time / count;
  if (!(spread > 0.0)) return false;
  const Eigen::Vector3d rate = origin_->angular_velocity + window.rate / count;
  const Eigen::Vector3d force = origin_->specific_force + window.force / count;
  const Eigen::Vector3d turning = force.cross(rate);
  const Eigen::Vector3d trend =
      (window.force_by_time - window.time / count * window.force) / spread;
  const Eigen::Vector3d all = deviation(window.force, window.force_squares, count).cwiseAbs2();
  // About the line; the deviation about the mean would hold the trend itself.
  const Eigen::Vector3d rest =
      ((count * all - spread * trend.cwiseAbs2()) / (count - 2)).cwiseMax(0.0);
  const double noise = std::sqrt(rest.maxCoeff() / spread);
  const double half = 0.5 * turning.norm();
  return half > kClear * noise && trend.dot(turning) > half * turning.norm();
}

bool StaticIntervalFinder::is_static(const Sums& window) const {
  if (window.samples < kMinSamples) return false;
  const Eigen::Vector3d mean = origin_->angular_velocity + window.rate / window.samples;
  return mean.norm() < kMaxRate &&
         deviation(window.rate, window.rate_squares, window.samples).maxCoeff() <
             kMaxRateDeviation &&
         deviation(window.force, window.force_squares, window.samples).maxCoeff() <
             kMaxForceDeviation &&
         !turns(window);
}

void StaticIntervalFinder::close_window() {
  if (is_static(window_)) {
    interval_.add(window_);
    if (interval_.end - interval_.begin > longest_.end - longest_.begin) longest_ = interval_;
  } else {
    interval_ = {};
  }
  window_ = {};
}

void StaticIntervalFinder::add(const ImuSample& sample) {
  if (!sample.angular_velocity.allFinite() || !sample.specific_force.allFinite()) return;
  if (!origin_) origin_ = sample;
  first_ = std::min(first_.value_or(sample.stamp), sample.stamp);
  const bool full = window_.samples > 0 &&
                    (sample.stamp - window_.begin >= kSecond || sample.stamp < window_.end);
  if (full) close_window();
  window_.add(sample, *origin_);
}

std::optional<StaticInterval> StaticIntervalFinder::longest() const {
  StaticIntervalFinder finished = *this;
  finished.close_window();
  const Sums& interval = finished.longest_;
  if (interval.samples < kMinSamples) return std::nullopt;
  const double period = to_seconds(interval.end - interval.begin) / (interval.samples - 1);
  StaticInterval found;
  found.begin_s = to_seconds(interval.begin - *first_);
  found.length_s = to_seconds(interval.end - interval.begin);
  found.gyro_bias = origin_->angular_velocity + interval.rate / interval.samples;
  found.force = origin_->specific_force + interval.force / interval.samples;
  const double to_density = std::sqrt(period);
  found.gyro_noise = to_density * deviation(interval.rate, interval.rate_squares, interval.samples);
  found.force_noise =
      to_density * deviation(interval.force, interval.force_squares, interval.samples);
  return found;
}

}  // namespace aims
