// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "recordings/clouds/point_cloud.hpp"
#include "recordings/clouds/ring_survey.hpp"
#include "recordings/clouds/stamp_steps.hpp"
#include "recordings/clouds/turn_parts.hpp"
#include "recordings/clouds/turn_times.hpp"
#include "recordings/reading_notes.hpp"

namespace aims {

/// Finds out from the first clouds of a recording how to read them.
class CloudSurvey {
 public:
  /// Adds the next cloud; `table` is valid. Clouds after the first 60 are ignored.
  void add(const PointTable& table, Time record_time);

  bool enough() const { return clouds_.size() >= 30; }
  std::size_t size() const { return clouds_.size(); }

  /// How to read the clouds; appends each assumption to `notes`, with the setting that changes it.
  CloudReading decide(const RecordingConfig& config, ReadingNotes& notes) const;

 private:
  /// Smallest and largest time of the points of one cloud.
  struct TimeRange {
    double first = 0.0, last = 0.0;  ///< in the field's own unit
  };
  struct Cloud {
    Time stamp = 0, arrival = 0;
    std::optional<Time> time_base;
    std::vector<std::optional<TimeRange>> ranges;  ///< by candidate field
  };
  void find_fields(const PointTable& table);
  static void extend(std::optional<TimeRange>& range, double time);
  void add_azimuth(const Eigen::Vector3d& position);
  void read_points(const PointTable& table, Cloud& cloud);
  bool unstamped() const { return hardly_advance(stamp_steps_, clouds_.size()); }
  Time time_of(const Cloud& cloud) const { return unstamped() ? cloud.arrival : cloud.stamp; }
  bool advances_with_stamps(std::size_t field, double unit_ns, double wrap_ns) const;
  bool is_normalized(std::size_t field, double span, Duration about) const;
  static void warn_of_length(Duration span, Duration about, const CloudReading& reading,
                             ReadingNotes& notes);
  static void warn_of_shortness(Duration span, const CloudReading& reading, ReadingNotes& notes);
  static std::string_view remedy_of(const TurnTimes& times);
  static void warn_of_fall(const TurnTimes& times, const CloudReading& reading,
                           ReadingNotes& notes);
  bool warn_of_scale(const TurnTimes& times, Duration about, const CloudReading& reading,
                     ReadingNotes& notes) const;
  std::vector<double> stamps_in_field(const CloudReading& reading) const;
  Duration mean_spacing() const;
  void stamp_by_record(CloudReading& reading, ReadingNotes& notes) const;
  bool decide_clock(const RecordingConfig& config, std::size_t field, Duration about,
                    CloudReading& reading) const;
  void decide_times(const RecordingConfig& config, CloudReading& reading,
                    ReadingNotes& notes) const;
  void note_azimuth_times(const CloudReading& reading, ReadingNotes& notes) const;
  void decide_stamp(const RecordingConfig& config, CloudReading& reading,
                    ReadingNotes& notes) const;
  void decide_unit(const RecordingConfig& config, CloudReading& reading, ReadingNotes& notes) const;
  void decide_intensity(CloudReading& reading, ReadingNotes& notes) const;
  std::vector<Time> stamps() const;
  std::optional<Duration> firing_span(std::size_t field, double unit_ns) const;
  double first_firing_ns(const CloudReading& reading) const;
  std::optional<double> median_first(std::size_t field) const;

  std::vector<Cloud> clouds_;
  std::size_t stamp_steps_ = 0;  ///< clouds with another stamp than the one before
  std::vector<std::string> time_fields_;
  std::vector<double> time_wraps_;  ///< of these, where an integer begins again at 0; 0: does not
  std::string intensity_field_;
  double largest_intensity_ = 0.0;
  std::vector<double> ranges_;  ///< of the first points [m]
  RingSurvey rings_;
  TurnPartFinder turn_parts_;
  std::vector<TurnTimes> turn_times_;                ///< by candidate field
  std::vector<std::optional<float>> last_azimuths_;  ///< in this cloud, by elevation [rad]
  int rising_azimuths_ = 0, falling_azimuths_ = 0;
};

}  // namespace aims
