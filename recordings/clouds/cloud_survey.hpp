// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "recordings/clouds/point_cloud.hpp"
#include "recordings/clouds/ring_survey.hpp"

namespace aims {

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
  void learn_fields(const PointTable& table);
  void learn_points(const PointTable& table, Cloud& cloud);
  bool decide_clock(const RecordingConfig& config, std::size_t field, Duration about,
                    CloudReading& reading) const;
  void decide_times(const RecordingConfig& config, CloudReading& reading,
                    std::vector<std::string>& notes) const;
  void decide_stamp(const RecordingConfig& config, CloudReading& reading,
                    std::vector<std::string>& notes) const;
  void decide_intensity(CloudReading& reading, std::vector<std::string>& notes) const;
  std::vector<Time> stamps() const;
  std::optional<double> median_first(std::size_t field) const;

  std::vector<Cloud> clouds_;
  std::vector<std::string> time_fields_;
  std::string intensity_field_;
  double largest_intensity_ = 0.0;
  RingSurvey rings_;
  int rising_azimuths_ = 0, falling_azimuths_ = 0;
};

}  // namespace aims
