// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "io/recording/point_cloud.hpp"

namespace aims {

/// Nominal period of the sweeps that start at `stamps`, some of which may be missing: the spacing
/// that most share, else the nearest whole number per second. `span`: how long points fire, if
/// known. Nothing without two different stamps or a span.
std::optional<Duration> sweep_period(std::vector<Time> stamps, std::optional<Duration> span);

/// Names under which drivers give the ring of a point, likeliest first.
std::span<const std::string_view> ring_field_names();

/// Learns from the first clouds of a recording how to read them.
class CloudSurvey {
 public:
  /// Takes the next cloud; `table` is valid. Later ones than the first 60 change nothing.
  void add(const PointTable& table, Time record_time);

  bool enough() const { return clouds_.size() >= 30; }
  std::size_t size() const { return clouds_.size(); }

  /// How to read the clouds; appends to `notes` what was assumed, with its remedy.
  CloudReading decide(const RecordingConfig& config, std::vector<std::string>& notes) const;

 private:
  /// What the points of one cloud say of their times.
  struct TimeRange {
    double first = 0.0, last = 0.0;  ///< in the field's own unit
  };
  struct Cloud {
    Time stamp = 0, arrival = 0;
    std::optional<Time> time_base;
    std::vector<std::optional<TimeRange>> ranges;  ///< by candidate field
  };
  struct RingMean {
    double elevation_sum = 0.0;
    int points = 0;
  };

  void learn_fields(const PointTable& table);
  void learn_rings(const PointTable& table, std::size_t index, const Eigen::Vector3d& position);
  void learn_points(const PointTable& table, Cloud& cloud);
  bool decide_clock(const RecordingConfig& config, std::size_t field, Duration about,
                    CloudReading& reading) const;
  void decide_times(const RecordingConfig& config, CloudReading& reading,
                    std::vector<std::string>& notes) const;
  void decide_stamp(const RecordingConfig& config, CloudReading& reading,
                    std::vector<std::string>& notes) const;
  void decide_rings(CloudReading& reading, std::vector<std::string>& notes) const;
  void decide_intensity(CloudReading& reading, std::vector<std::string>& notes) const;
  std::vector<Time> stamps() const;
  std::optional<double> median_first(std::size_t field) const;

  std::vector<Cloud> clouds_;
  std::vector<std::string> time_fields_;
  std::string ring_field_;
  RingSource ring_source_ = RingSource::kNone;
  std::string intensity_field_;
  double largest_intensity_ = 0.0;
  std::vector<RingMean> rings_;
  std::vector<float> elevations_;
  int rising_azimuths_ = 0, falling_azimuths_ = 0;
};

}  // namespace aims
