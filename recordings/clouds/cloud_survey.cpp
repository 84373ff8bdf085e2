// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/clouds/cloud_survey.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>
#include <utility>

#include "core/median.hpp"
#include "recordings/clouds/scan_period.hpp"

namespace aims {
namespace {

constexpr std::size_t kMaxClouds = 60;
constexpr std::size_t kMaxRanges = 100'000;
/// Half of the points of no LiDAR on a robot are farther away [m].
constexpr double kFarPoints = 120.0;          ///< of half of the points, at most [m]
constexpr double kFarInCentimetres = 1000.0;  ///< more than that is likely in mm

constexpr std::array<std::string_view, 5> kIntensityFields = {"intensity", "reflectivity", "i",
                                                              "intensities", "signal"};

/// Where counters of that type begin again; 0: nowhere.
double wrap_of(NumberType type) {
  if (type == NumberType::kUint16) return 65536.0;
  return type == NumberType::kUint32 ? 4294967296.0 : 0.0;
}

/// Points whose elevations differ by less are of one ring, of which the azimuths tell the spin
/// [rad].
constexpr double kElevationBin = 1e-3;

}  // namespace

void CloudSurvey::find_fields(const PointTable& table) {
  for (const std::string_view name : time_field_names()) {
    const ColumnLayout* column = table.find(name);
    if (column == nullptr || std::ranges::find(time_fields_, name) != time_fields_.end()) continue;
    time_fields_.emplace_back(name);
    time_wraps_.push_back(wrap_of(column->type));
  }
  const ColumnLayout* intensity = table.find_any(kIntensityFields);
  if (intensity_field_.empty() && intensity != nullptr) intensity_field_ = intensity->name;
}

void CloudSurvey::extend(std::optional<TimeRange>& range, double time) {
  if (!std::isfinite(time)) return;
  if (!range) range = TimeRange{time, time};
  range->first = std::min(range->first, time);
  range->last = std::max(range->last, time);
}

/// In which direction the azimuth changes from point to point of a ring: in firing order the points
/// between them are of other rings.
void CloudSurvey::add_azimuth(const Eigen::Vector3d& position) {
  constexpr double kLeast = 1e-5, kMost = 0.2;  // [rad]
  const double elevation = std::atan2(position.z(), std::hypot(position.x(), position.y()));
  const auto bin = static_cast<std::size_t>((elevation + std::numbers::pi / 2.0) / kElevationBin);
  const double azimuth = std::atan2(position.y(), position.x());
  std::optional<float>& last = last_azimuths_.at(bin);
  const double step = last ? azimuth - static_cast<double>(*last) : 0.0;
  if (std::abs(step) > kLeast && std::abs(step) < kMost) {
    ++(step > 0.0 ? rising_azimuths_ : falling_azimuths_);
  }
  last = static_cast<float>(azimuth);
}

void CloudSurvey::read_points(const PointTable& table, Cloud& cloud) {
  std::vector<std::optional<PointField>> times;
  for (const std::string& name : time_fields_) {
    const ColumnLayout* column = table.find(name);
    times.push_back(column ? std::optional(PointField(table, *column)) : std::nullopt);
  }
  const ColumnLayout* intensity = intensity_field_.empty() ? nullptr : table.find(intensity_field_);
  const PointField x(table, *table.find("x")), y(table, *table.find("y")),
      z(table, *table.find("z"));
  cloud.ranges.resize(times.size());
  rings_.begin(table);
  turn_parts_.begin();
  turn_times_.resize(times.size());
  for (TurnTimes& each : turn_times_) each.begin(clouds_.size());
  last_azimuths_.assign(static_cast<std::size_t>(std::numbers::pi / kElevationBin) + 1, {});
  for (std::size_t i = 0; i < table.size(); ++i) {
    const std::byte* bytes = table.point(i);
    const Eigen::Vector3d position(x.at(bytes), y.at(bytes), z.at(bytes));
    if (!position.allFinite() || position.isZero(0.0)) continue;
    rings_.add(table, i, position);
    turn_parts_.add(position);
    if (ranges_.size() < kMaxRanges) ranges_.push_back(position.norm());
    add_azimuth(position);
    if (intensity != nullptr) {
      const double value = PointField(table, *intensity).at(bytes);
      if (std::isfinite(value)) largest_intensity_ = std::max(largest_intensity_, value);
    }
    for (std::size_t field = 0; field < times.size(); ++field) {
      if (!times[field]) continue;
      const double time = times[field]->at(bytes);
      extend(cloud.ranges[field], time);
      turn_times_[field].add(position, time);
    }
  }
}

void CloudSurvey::add(const PointTable& table, Time record_time) {
  if (clouds_.size() >= kMaxClouds) return;
  find_fields(table);
  stamp_steps_ += !clouds_.empty() && table.stamp != clouds_.back().stamp ? 1 : 0;
  Cloud cloud{table.stamp, record_time, table.time_base, {}};
  read_points(table, cloud);
  clouds_.push_back(std::move(cloud));
}

/// 0 of fewer than two stamps.
Duration CloudSurvey::mean_spacing() const {
  const std::vector<Duration> all = spacings(stamps());
  const Duration sum = std::accumulate(all.begin(), all.end(), Duration{0});
  return all.empty() ? 0 : sum / std::ssize(all);
}

std::vector<Time> CloudSurvey::stamps() const {
  std::vector<Time> all;
  for (const Cloud& cloud : clouds_) all.push_back(time_of(cloud));
  return all;
}

/// Clouds without stamps have their record times, at which their scans are complete.
void CloudSurvey::stamp_by_record(CloudReading& reading, ReadingNotes& notes) const {
  const bool before = first_firing_ns(reading) < -0.5 * static_cast<double>(reading.period);
  reading.stamp = CloudStamp::kEnd;
  reading.counted_from_start = reading.clock != PointClock::kStamp || !before;
  notes.warn("clouds without stamps",
             "stamps of clouds do not advance: their record times serve, as the end of the scans "
             "(cloud_stamp)");
}

/// Whether the stamp marks the start or the end of the scan.
void CloudSurvey::decide_stamp(const RecordingConfig& config, CloudReading& reading,
                               ReadingNotes& notes) const {
  if (unstamped() && config.cloud_stamp == CloudStamp::kAuto)
    return stamp_by_record(reading, notes);
  const auto period = static_cast<double>(reading.period);
  std::vector<double> latencies;
  for (const Cloud& cloud : clouds_) {
    latencies.push_back(static_cast<double>(cloud.arrival) - static_cast<double>(cloud.stamp));
  }
  const double first = first_firing_ns(reading);
  const double latency = upper_median(latencies).value_or(period);
  // A cloud cannot arrive before its scan is complete. A latency of exactly 0 is no measurement.
  const bool too_early = latency < 0.5 * period && latency > -0.5 * period && latency != 0.0;
  const bool to_stamp = reading.clock == PointClock::kStamp || reading.clock == PointClock::kEpoch;
  reading.counted_from_start = !to_stamp;
  reading.stamp = CloudStamp::kStart;
  if (config.cloud_stamp != CloudStamp::kAuto) {
    reading.stamp = config.cloud_stamp;
    // Times that begin with the scan although the stamp is configured as its end.
    if (reading.clock == PointClock::kStamp && first > -0.2 * period) {
      reading.counted_from_start = true;
    }
  } else if (to_stamp && first < -0.5 * period) {
    reading.stamp = CloudStamp::kEnd;
    notes.push_back("points fire before their cloud's stamp: it marks the end of the scan");
  } else if (!to_stamp && too_early) {
    reading.stamp = CloudStamp::kEnd;
    notes.warn(
        "stamps of clouds assumed to mark the end of the scan",
        fmt::format("clouds arrive {:.1f} ms after their stamp, before a scan that starts there "
                    "is complete: the stamp is taken as the end (cloud_stamp)",
                    1e-6 * latency));
  } else if (reading.clock == PointClock::kStamp && too_early && latency > 0.0 &&
             first > -0.2 * period) {
    reading.stamp = CloudStamp::kEnd;
    reading.counted_from_start = true;
    notes.warn("stamps of clouds assumed to mark the end of the scan",
               fmt::format("clouds arrive {:.1f} ms after their stamp, though their points count "
                           "from it to {:.0f} ms: the stamp is taken as the end of the scan "
                           "(cloud_stamp)",
                           1e-6 * latency, 1e-6 * period));
  } else if (to_stamp && too_early) {
    notes.warn(
        "which end of the scan the stamps of clouds mark",
        fmt::format("clouds arrive {:.1f} ms after their stamp although their points fire later: "
                    "if the stamp marks the end, set cloud_stamp: end",
                    1e-6 * latency));
  }
}

void CloudSurvey::decide_intensity(CloudReading& reading, ReadingNotes& notes) const {
  reading.intensity_field = intensity_field_;
  if (intensity_field_.empty() || largest_intensity_ <= 1.0) return;
  const double full = largest_intensity_ <= 255.0 ? 255.0 : 65535.0;
  reading.intensity_scale = static_cast<float>(1.0 / full);
  notes.push_back(fmt::format("point field '{}' up to {:.4g}: divided by {:g}", intensity_field_,
                              largest_intensity_, full));
}

/// The unit of the coordinates, which their ranges give away.
void CloudSurvey::decide_unit(const RecordingConfig& config, CloudReading& reading,
                              ReadingNotes& notes) const {
  if (config.point_unit != PointUnit::kMetres) {
    const bool centimetres = config.point_unit == PointUnit::kCentimetres;
    reading.position_scale = centimetres ? 0.01 : 0.001;
    notes.push_back(fmt::format("points in {} (recording.point_unit): converted to metres",
                                centimetres ? "cm" : "mm"));
  }
  const double range = reading.position_scale * upper_median(ranges_).value_or(0.0);
  if (range <= kFarPoints) return;
  const std::string_view likely = range > kFarInCentimetres ? "mm" : "cm";
  notes.warn("points not in metres",
             fmt::format("half of the points are farther than {:.0f} m: points in {}? Then set "
                         "recording.point_unit={}",
                         range, likely, likely));
}

CloudReading CloudSurvey::decide(const RecordingConfig& config, ReadingNotes& notes) const {
  CloudReading reading;
  reading.clockwise = config.lidar_clockwise;
  reading.parts = turn_parts_.find();
  decide_times(config, reading, notes);
  decide_stamp(config, reading, notes);
  rings_.decide(reading, notes);
  decide_intensity(reading, notes);
  decide_unit(config, reading, notes);
  if (reading.parts.count > 1) {
    notes.push_back(fmt::format(
        "each cloud is a part of a turn, of {:.3g} deg: {} of them are joined to a scan of {:.4g} "
        "s",
        360.0 / reading.parts.count, reading.parts.count, to_seconds(reading.scan_period())));
  }
  return reading;
}

}  // namespace aims
