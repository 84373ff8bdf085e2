// SPDX-License-Identifier: BSD-3-Clause
// How the times of points are read: their field, unit and clock, and the period of the scans.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "core/median.hpp"
#include "recordings/clouds/cloud_survey.hpp"
#include "recordings/clouds/scan_period.hpp"

namespace aims {
namespace {

/// Larger point times are not relative to the scan [ns].
constexpr double kMaxRelativeTime = 5e9;
/// Counters that begin again sooner cannot be told from times within the scan [ns].
constexpr double kMinWrap = 2e9;

struct Unit {
  PointTimeUnit unit;
  double ns;
  std::string_view name;
};
constexpr std::array<Unit, 4> kUnits = {{{PointTimeUnit::kSeconds, 1e9, "s"},
                                         {PointTimeUnit::kMilliseconds, 1e6, "ms"},
                                         {PointTimeUnit::kMicroseconds, 1e3, "us"},
                                         {PointTimeUnit::kNanoseconds, 1.0, "ns"}}};

std::string_view unit_name(double ns) {
  for (const Unit& unit : kUnits) {
    if (unit.ns == ns) return unit.name;
  }
  return "?";
}

}  // namespace

std::optional<double> CloudSurvey::median_first(std::size_t field) const {
  std::vector<double> all;
  for (const Cloud& cloud : clouds_) {
    if (cloud.ranges.size() > field && cloud.ranges[field]) {
      all.push_back(cloud.ranges[field]->first);
    }
  }
  return upper_median(all);
}

/// Whether the field runs from 0 to 1, or from -1 to 0, during a scan that does not last a second.
bool CloudSurvey::is_normalized(std::size_t field, double span, Duration about) const {
  const double first = median_first(field).value_or(0.0);
  const double last = first + span;
  const bool after = first > -1e-6 && last<1.0001, before = first> - 1.0001 && last < 1e-6;
  const bool unit_range = span > 0.8 && span < 1.0001 && (after || before);
  return unit_range && about < kLongestScan * 2 / 3;
}

/// Whether the field is a clock that runs on from cloud to cloud as the stamps do.
bool CloudSurvey::advances_with_stamps(std::size_t field, double unit_ns, double wrap_ns) const {
  const Cloud* last = nullptr;
  int together = 0, apart = 0;
  for (const Cloud& cloud : clouds_) {
    if (cloud.ranges.size() <= field || !cloud.ranges[field]) continue;
    const Cloud* before = std::exchange(last, &cloud);
    const double step = before ? static_cast<double>(time_of(cloud) - time_of(*before)) : 0.0;
    if (!(step > 0.0)) continue;
    double run = (cloud.ranges[field]->first - before->ranges[field]->first) * unit_ns;
    if (run < 0.0) run += wrap_ns;
    ++(std::abs(run - step) < 0.5 * step ? together : apart);
  }
  return together > apart;
}

/// Whether the field advances during a scan as a time does; if so, how to read it.
bool CloudSurvey::decide_clock(const RecordingConfig& config, std::size_t field, Duration about,
                               CloudReading& reading) const {
  std::vector<double> spans;
  for (const Cloud& cloud : clouds_) {
    if (cloud.ranges.size() <= field || !cloud.ranges[field]) continue;
    spans.push_back(cloud.ranges[field]->last - cloud.ranges[field]->first);
  }
  const std::optional<double> span = upper_median(spans);
  if (!span || !(*span > 0.0)) return false;
  std::optional<double> unit = time_unit(*span, about);
  reading.normalized_times =
      is_normalized(field, *span, about) && config.point_time_unit == PointTimeUnit::kAuto;
  if (reading.normalized_times) unit = static_cast<double>(about);
  for (const Unit& each : kUnits) {
    if (each.unit == config.point_time_unit) unit = each.ns;
  }
  if (!unit) return false;
  reading.time_field = time_fields_[field];
  reading.time_unit = *unit;
  reading.clock = PointClock::kStamp;
  std::vector<double> delays;  // of the first firing after the stamp, on the stamps' clock [ns]
  for (const Cloud& cloud : clouds_) {
    if (cloud.ranges.size() <= field || !cloud.ranges[field]) continue;
    const double first = cloud.ranges[field]->first * *unit;
    const double base = static_cast<double>(cloud.time_base.value_or(0));
    delays.push_back(base + first - static_cast<double>(cloud.stamp));
  }
  const double first = *median_first(field) * *unit;
  const bool has_base = std::any_of(clouds_.begin(), clouds_.end(),
                                    [](const Cloud& cloud) { return cloud.time_base.has_value(); });
  const bool same_clock = std::abs(*upper_median(delays)) < static_cast<double>(kLongestScan);
  // A clock that counts from boot may be small, as stamps may be; then it runs on with them.
  reading.time_wrap = time_wraps_[field] * *unit > kMinWrap ? time_wraps_[field] * *unit : 0.0;
  const bool advances = advances_with_stamps(field, *unit, reading.time_wrap);
  const bool from_stamp = std::abs(first) < kMaxRelativeTime && !advances;
  if (has_base) {
    reading.clock = same_clock ? PointClock::kEpoch : PointClock::kStamp;
  } else if (!from_stamp) {
    reading.clock = same_clock ? PointClock::kEpoch : PointClock::kOther;
  }
  return true;
}

/// Median duration from the first to the last firing of a cloud, by the chosen field.
std::optional<Duration> CloudSurvey::firing_span(std::size_t field, double unit_ns) const {
  std::vector<Duration> spans;
  for (const Cloud& cloud : clouds_) {
    if (cloud.ranges.size() <= field || !cloud.ranges[field]) continue;
    const auto length = point_time(cloud.ranges[field]->last - cloud.ranges[field]->first, unit_ns);
    if (length && *length > 0 && *length <= kLongestScan) spans.push_back(*length);
  }
  return upper_median(spans);
}

/// Warns of point times that last longer than the scans.
void CloudSurvey::warn_of_length(Duration span, Duration about, const CloudReading& reading,
                                 ReadingNotes& notes) {
  notes.warn(
      "point times longer than the scan",
      fmt::format("point field '{}' spans {:.4g} s, but a cloud comes every {:.4g} s: is its "
                  "unit not {} (point_time_unit), or its scale another one?",
                  reading.time_field, to_seconds(span), to_seconds(about),
                  unit_name(reading.time_unit)));
}

/// Warns of point times of a turn that is over long before the next cloud.
void CloudSurvey::warn_of_shortness(Duration span, const CloudReading& reading,
                                    ReadingNotes& notes) {
  notes.warn(
      "point times shorter than the scan",
      fmt::format("point field '{}' spans {:.4g} s, but clouds come every {:.4g} s: were those "
                  "between them left out on purpose, or is its unit not {} (point_time_unit), or "
                  "its scale another one?",
                  reading.time_field, to_seconds(span), to_seconds(reading.spacing),
                  unit_name(reading.time_unit)));
}

/// The stamps of the clouds on the clock of the points' times, in the unit of their field.
std::vector<double> CloudSurvey::stamps_in_field(const CloudReading& reading) const {
  const auto name = std::ranges::find(time_fields_, reading.time_field);
  const auto field = static_cast<std::size_t>(name - time_fields_.begin());
  std::vector<double> all;
  for (const Cloud& cloud : clouds_) {
    const bool known = cloud.ranges.size() > field && cloud.ranges[field];
    double stamp = 0.0;
    if (reading.clock == PointClock::kEpoch) {
      stamp = static_cast<double>(cloud.stamp - cloud.time_base.value_or(0)) / reading.time_unit;
    } else if (reading.clock == PointClock::kOther && known) {
      stamp = cloud.ranges[field]->first;
    }
    all.push_back(stamp);
  }
  return all;
}

/// What to do about times that cannot serve.
std::string_view CloudSurvey::remedy_of(const TurnTimes& times) {
  return times.turn() ? "correct them in the driver, or set recording.point_time_unit=none: then "
                        "azimuths serve in their place"
                      : "correct them in the driver";
}

/// Warns of times that fall where they should rise.
void CloudSurvey::warn_of_fall(const TurnTimes& times, const CloudReading& reading,
                               ReadingNotes& notes) {
  if (!times.fall()) return;
  notes.warn(WarningKind::kPointTimes, "point times run backwards",
             fmt::format("point field '{}' falls from point to point of each ring: its times run "
                         "backwards, as with the wrong sign (or the points are stored in reverse "
                         "order, which is no fault); {}",
                         reading.time_field, remedy_of(times)));
}

/// Warns of times of a spinning LiDAR that its azimuths contradict; whether they do.
bool CloudSurvey::warn_of_scale(const TurnTimes& times, Duration about, const CloudReading& reading,
                                ReadingNotes& notes) const {
  constexpr double kMostMisfit = 0.15;  // of a turn
  if (unstamped()) return false;
  const auto turn = times.turn();
  const auto misfit = times.misfit(stamps(), stamps_in_field(reading), reading.time_unit);
  if (!turn || !misfit || std::abs(*misfit) < kMostMisfit) return false;
  const double length = 1e-9 * reading.time_unit * std::abs(*turn);
  const double whole = to_seconds(about) * reading.parts.count;
  notes.warn(
      WarningKind::kPointTimes, "point times of another scale",
      fmt::format("by point field '{}' a turn takes {:.3g} s, but by the azimuths of clouds "
                  "that come every {:.3g} s it does not: the times are perhaps {:.2g} times "
                  "the true ones; {}",
                  reading.time_field, length, to_seconds(about), length / whole, remedy_of(times)));
  return true;
}

void CloudSurvey::note_azimuth_times(const CloudReading& reading, ReadingNotes& notes) const {
  notes.warn(
      "point times derived from azimuth",
      fmt::format("{}: derived from azimuth, spinning {}, {:.4g} s per turn "
                  "(lidar_clockwise, lidar_rate)",
                  time_fields_.empty() ? "points have no time" : "times of points do not serve",
                  reading.clockwise ? "clockwise" : "counter-clockwise",
                  to_seconds(reading.scan_period())));
  const int steps = rising_azimuths_ + falling_azimuths_;
  const int opposite = reading.clockwise ? rising_azimuths_ : falling_azimuths_;
  if (steps > 100 && opposite > 0.7 * steps) {
    notes.warn("direction of spin",
               fmt::format("azimuths change in the opposite direction from point to point: set "
                           "lidar_clockwise: {}",
                           !reading.clockwise));
  }
}

/// Median time of the first firing after the cloud's stamp [ns]; 0 without times.
double CloudSurvey::first_firing_ns(const CloudReading& reading) const {
  std::vector<double> firsts;
  for (const Cloud& cloud : clouds_) {
    for (std::size_t field = 0; field < cloud.ranges.size(); ++field) {
      if (time_fields_[field] != reading.time_field || !cloud.ranges[field]) continue;
      double first = cloud.ranges[field]->first * reading.time_unit;
      if (reading.clock == PointClock::kEpoch) {
        first -= static_cast<double>(cloud.stamp - cloud.time_base.value_or(0));
      }
      firsts.push_back(first);
    }
  }
  return upper_median(firsts).value_or(0.0);
}

void CloudSurvey::decide_times(const RecordingConfig& config, CloudReading& reading,
                               ReadingNotes& notes) const {
  const Duration fallback = from_seconds(1.0 / config.lidar_rate);
  const Duration about =
      std::min(upper_median(spacings(stamps())).value_or(fallback), kLongestScan);
  std::optional<Duration> span;
  const bool unused = config.point_time_unit == PointTimeUnit::kNone;
  std::size_t field = 0;
  for (; field < time_fields_.size() && !unused; ++field) {
    if (decide_clock(config, field, about, reading)) {
      span = firing_span(field, reading.time_unit);
      break;
    }
    notes.push_back(fmt::format("point field '{}' does not advance during the scan: not a time",
                                time_fields_[field]));
  }
  const bool too_long = span && 2 * *span >= 3 * std::max(about, mean_spacing());
  const std::optional<Duration> period =
      scan_period(stamps(), too_long ? std::nullopt : span, 1.0 - turn_parts_.blind_part());
  reading.period =
      std::clamp(period.value_or(fallback), kMillisecond, static_cast<Duration>(kLongestScan));
  reading.spacing = usual_spacing(stamps(), reading.period);
  if (!period) {
    notes.push_back(fmt::format("too few clouds to measure the scan period: {:g} s from lidar_rate",
                                to_seconds(reading.period)));
  }
  if (reading.clock == PointClock::kNone) return note_azimuth_times(reading, notes);
  static constexpr std::array<std::string_view, 4> kOrigins = {
      "", "relative to the cloud's stamp", "on the clock of the stamps",
      "on another clock, of which only differences are used"};
  const TurnTimes& times = turn_times_[field];
  warn_of_fall(times, reading, notes);
  if (reading.normalized_times) {
    return notes.warn(
        "point times assumed to be fractions of the scan",
        fmt::format("point field '{}' runs from {} over scans of {:.4g} s: taken as fraction of "
                    "the scan (point_time_unit: s reads it as seconds)",
                    reading.time_field, first_firing_ns(reading) < 0.0 ? "-1 to 0" : "0 to 1",
                    to_seconds(reading.period)));
  }
  const bool overlaps = span && 5 * *span >= 6 * std::max(about, mean_spacing());
  if (!warn_of_scale(times, about, reading, notes)) {
    if (too_long || (overlaps && !times.turn())) warn_of_length(*span, about, reading, notes);
    if (span && reading.spacing > reading.period) warn_of_shortness(*span, reading, notes);
  }
  notes.push_back(fmt::format("point time: field '{}' in {}, {}", reading.time_field,
                              unit_name(reading.time_unit),
                              kOrigins[static_cast<std::size_t>(reading.clock)]));
}

}  // namespace aims
