// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/filter/imu_history.hpp"

#include <algorithm>

namespace aims {
namespace {

/// Samples averaged over a long gap: two trot periods at 50 Hz.
constexpr std::size_t kBridgeSamples = 40;

bool before(const ImuSample& a, Time stamp) { return a.stamp < stamp; }

}  // namespace

ImuHistory::ImuHistory(const ImuPropagationConfig& config, double rate_hz)
    : config_(config), period_(from_seconds(1.0 / rate_hz)), noise_(rate_hz) {}

bool ImuHistory::insert(const ImuSample& sample) {
  const auto at = std::lower_bound(samples_.begin(), samples_.end(), sample.stamp, before);
  if (at != samples_.end() && at->stamp == sample.stamp) return false;
  samples_.insert(at, sample);
  return true;
}

void ImuHistory::observe_noise(Time until) {
  for (const ImuSample& sample : samples_) {
    if (time_of(sample) > until) break;
    if (last_observed_ && sample.stamp <= *last_observed_) continue;
    noise_.add(sample);
    last_observed_ = sample.stamp;
  }
}

/// The segment that ends at sample `index`. Rate and force change linearly within it: to second
/// order the rotation gains T/12 w0 x w1 per time (coning), the velocity T/12 (w0 x f1 - w1 x f0)
/// (sculling; Savage 1998, with w and f at both ends).
InertialSegment ImuHistory::measured_segment(std::size_t index) const {
  const ImuSample& sample = samples_[index];
  const bool gap = index == 0 || sample.stamp - samples_[index - 1].stamp > period_ * 3 / 2;
  if (gap) {
    return {time_of(sample) - period_,
            time_of(sample),
            sample.angular_velocity,
            sample.specific_force,
            true,
            {}};
  }
  const ImuSample& last = samples_[index - 1];
  const Eigen::Vector3d& w0 = last.angular_velocity;
  const Eigen::Vector3d& w1 = sample.angular_velocity;
  const Eigen::Vector3d& f0 = last.specific_force;
  const Eigen::Vector3d& f1 = sample.specific_force;
  const double twelfth = to_seconds(sample.stamp - last.stamp) / 12.0;
  return {time_of(last),
          time_of(sample),
          0.5 * (w0 + w1) + twelfth * w0.cross(w1),
          0.5 * (f0 + f1) + twelfth * (w0.cross(f1) - w1.cross(f0)),
          true,
          {}};
}

InertialSegment ImuHistory::bridge(std::size_t next) const {
  InertialSegment segment;
  segment.measured = false;
  if (samples_.empty()) {
    segment.specific_force = Eigen::Vector3d(0.0, 0.0, config_.gravity);
    return segment;
  }
  const bool has_next = next < samples_.size();
  const bool short_gap =
      has_next && next > 0 &&
      samples_[next].stamp - samples_[next - 1].stamp <= 3 * period_ + period_ / 2;
  const std::size_t last = has_next ? next + 1 : next;  // one past the newest sample used
  const std::size_t wanted = short_gap ? 2 : kBridgeSamples;
  const std::size_t first = last > wanted ? last - wanted : 0;
  for (std::size_t i = first; i < last; ++i) {
    segment.angular_velocity += samples_[i].angular_velocity;
    segment.specific_force += samples_[i].specific_force;
  }
  segment.angular_velocity /= static_cast<double>(last - first);
  segment.specific_force /= static_cast<double>(last - first);
  return segment;
}

void ImuHistory::segments(Time begin, Time end, std::vector<InertialSegment>& segments) const {
  segments.clear();
  const auto at = std::upper_bound(samples_.begin(), samples_.end(), begin + delay_,
                                   [](Time stamp, const ImuSample& s) { return stamp < s.stamp; });
  auto index = static_cast<std::size_t>(at - samples_.begin());
  while (begin < end) {
    InertialSegment next = index < samples_.size() ? measured_segment(index) : bridge(index);
    if (next.measured && next.begin > begin) {  // samples are missing before this one
      const Time until = std::min(next.begin, end);
      next = bridge(index);
      next.end = until;
    } else if (next.measured) {
      next.end = std::min(next.end, end);
      ++index;
    } else {
      next.end = end;
    }
    next.begin = begin;
    next.noise = next.measured ? noise_.density() : noise_.bridge_density();
    begin = next.end;
    segments.push_back(next);
  }
}

std::optional<Eigen::Vector3d> ImuHistory::angular_velocity_at(Time stamp) const {
  const auto at = std::lower_bound(samples_.begin(), samples_.end(), stamp + delay_, before);
  if (at == samples_.end()) return std::nullopt;
  const InertialSegment segment = measured_segment(static_cast<std::size_t>(at - samples_.begin()));
  if (stamp < segment.begin) return std::nullopt;
  return segment.angular_velocity;
}

std::optional<Time> ImuHistory::newest() const {
  if (samples_.empty()) return std::nullopt;
  return time_of(samples_.back());
}

std::vector<ImuSample> ImuHistory::samples_between(std::optional<Time> after, Time until) const {
  std::vector<ImuSample> samples;
  for (const ImuSample& sample : samples_) {
    if ((!after || sample.stamp > *after) && sample.stamp <= until) samples.push_back(sample);
  }
  return samples;
}

void ImuHistory::forget_before(Time stamp) {
  std::size_t old = 0;
  while (samples_.size() > old + kBridgeSamples && time_of(samples_[old + 1]) < stamp) ++old;
  samples_.erase(samples_.begin(), samples_.begin() + static_cast<std::ptrdiff_t>(old));
}

}  // namespace aims
