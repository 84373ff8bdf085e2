// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "core/measurements.hpp"
#include "estimator/filter/imu_noise.hpp"
#include "estimator/filter/imu_propagation.hpp"

namespace aims {

/// Recent inertial samples in order of stamp; cuts any time span into segments. A sample is taken
/// as the value at an instant, `delay` before its stamp, and a segment between two samples has
/// their mean: an average over the interval before the stamp is late by half of that interval.
/// Every time in this interface is on the clock of the LiDAR, stamp - delay.
class ImuHistory {
 public:
  /// `rate_hz`: nominal sample rate [Hz].
  ImuHistory(const ImuPropagationConfig& config, double rate_hz);

  /// Inserts a sample in order of stamp; false when its stamp is already present.
  bool insert(const ImuSample& sample);

  /// The delay of the stamps; 0 before the first call.
  void set_delay(Duration delay) { delay_ = delay; }
  Duration delay() const { return delay_; }

  /// Adds the samples up to `until` to the estimated noise, in order of stamp: what arrives when
  /// makes no difference.
  void observe_noise(Time until);

  ImuNoise& noise() { return noise_; }
  const ImuNoise& noise() const { return noise_; }

  /// Replaces `segments` by consecutive segments that cover (begin, end]. Missing samples are
  /// replaced by the mean of both neighbours over a short gap, by the recent mean over a long one.
  void segments(Time begin, Time end, std::vector<InertialSegment>& segments) const;

  /// The angular velocity at `stamp` [rad/s]; empty where no sample covers it.
  std::optional<Eigen::Vector3d> angular_velocity_at(Time stamp) const;

  /// Stamp of the newest sample; empty before the first.
  std::optional<Time> newest() const;

  /// Removes samples that end before `stamp`; enough recent ones stay to bridge a gap.
  void forget_before(Time stamp);

  /// With their own stamps.
  const std::vector<ImuSample>& samples() const { return samples_; }

  /// Those of (after, until], likewise.
  std::vector<ImuSample> samples_between(std::optional<Time> after, Time until) const;

 private:
  InertialSegment measured_segment(std::size_t index) const;
  InertialSegment bridge(std::size_t next) const;
  Time time_of(const ImuSample& sample) const { return sample.stamp - delay_; }

  ImuPropagationConfig config_;
  Duration period_;
  Duration delay_ = 0;
  ImuNoise noise_;
  std::optional<Time> last_observed_;  ///< stamp of the newest sample in `noise_`
  std::vector<ImuSample> samples_;
};

}  // namespace aims
