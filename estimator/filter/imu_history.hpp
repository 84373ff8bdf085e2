// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <deque>
#include <optional>
#include <vector>

#include "core/measurements.hpp"
#include "estimator/filter/imu_propagation.hpp"

namespace aims {

/// Recent inertial samples in order of stamp; cuts any time span into segments.
class ImuHistory {
 public:
  /// `rate_hz`: nominal sample rate [Hz].
  ImuHistory(const ImuPropagationConfig& config, double rate_hz);

  /// Inserts a sample in order of stamp; false when its stamp is already present.
  bool insert(const ImuSample& sample);

  /// Replaces `segments` by consecutive segments that cover (begin, end]. Missing samples are
  /// replaced by the mean of both neighbours over a short gap, by the recent mean over a long one.
  void segments(Time begin, Time end, std::vector<InertialSegment>& segments) const;

  /// The angular velocity at `stamp` [rad/s]; empty where no sample covers it.
  std::optional<Eigen::Vector3d> angular_velocity_at(Time stamp) const;

  /// Stamp of the newest sample; empty before the first.
  std::optional<Time> newest() const;

  /// Removes samples that end before `stamp`; enough recent ones stay to bridge a gap.
  void forget_before(Time stamp);

  const std::deque<ImuSample>& samples() const { return samples_; }

 private:
  InertialSegment measured_segment(std::size_t index) const;
  InertialSegment bridge(std::size_t next) const;

  ImuPropagationConfig config_;
  Duration period_;
  std::deque<ImuSample> samples_;
};

}  // namespace aims
