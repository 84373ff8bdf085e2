// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/clouds/point_cloud.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace aims {
namespace {

/// Largest difference between the time of a point and its cloud's stamp.
constexpr Duration kMaxPointOffset = kSecond;
constexpr double kTurn = 2.0 * std::numbers::pi;
/// Azimuth margin before the first point within which an early point belongs to the start [rad].
constexpr double kStartMargin = 0.02;

/// The fields of a cloud that are read.
struct Columns {
  PointField x, y, z;
  std::optional<PointField> time, ring, intensity;
};

std::optional<PointField> field(const PointTable& table, const std::string& name) {
  const ColumnLayout* column = name.empty() ? nullptr : table.find(name);
  if (column == nullptr) return std::nullopt;
  return PointField(table, *column);
}

Columns columns_of(const PointTable& table, const CloudReading& reading) {
  const bool timed = reading.clock != PointClock::kNone;
  const bool ringed = reading.ring_source == RingSource::kField;
  return {*field(table, "x"),
          *field(table, "y"),
          *field(table, "z"),
          timed ? field(table, reading.time_field) : std::nullopt,
          ringed ? field(table, reading.ring_field) : std::nullopt,
          field(table, reading.intensity_field)};
}

std::uint16_t ring_of_elevation(const Eigen::Vector3f& p, const std::vector<double>& elevations) {
  const double elevation = std::atan2(p.z(), std::hypot(p.x(), p.y()));
  const auto above = std::lower_bound(elevations.begin(), elevations.end(), elevation);
  auto nearest = above;
  if (above == elevations.end() ||
      (above != elevations.begin() && elevation - *(above - 1) < *above - elevation)) {
    --nearest;
  }
  return static_cast<std::uint16_t>(nearest - elevations.begin());
}

/// Reads the points of one cloud, with times relative to `zero`.
class CloudDecoder {
 public:
  CloudDecoder(const PointTable& table, const CloudReading& reading, EventCounts& counts)
      : table_(table), reading_(reading), counts_(counts), columns_(columns_of(table, reading)) {
    zero_ = zero();
  }

  std::vector<LidarPoint> points();

 private:
  Time zero() const;
  bool read_time(const std::byte* bytes, LidarPoint& point);
  double ring(const std::byte* bytes, std::size_t index, const LidarPoint& point) const;
  void count(const char* what, int times) {
    if (times > 0) counts_[what] += times;
  }

  const PointTable& table_;
  const CloudReading& reading_;
  EventCounts& counts_;
  Columns columns_;
  Time zero_ = 0;  ///< on the clock of the points' field
};

/// Origin of the points' times, on the clock of their field.
Time CloudDecoder::zero() const {
  if (reading_.clock == PointClock::kEpoch) {
    return table_.time_base ? table_.stamp - *table_.time_base : table_.stamp;
  }
  if (reading_.clock != PointClock::kOther || !columns_.time) return 0;
  std::optional<Time> first;
  for (std::size_t i = 0; i < table_.size(); ++i) {
    const auto time = point_time(columns_.time->at(table_.point(i)), reading_.time_unit);
    if (time && (!first || *time < *first)) first = time;
  }
  return first.value_or(0);
}

bool CloudDecoder::read_time(const std::byte* bytes, LidarPoint& point) {
  if (!columns_.time) return true;
  const auto time = point_time(columns_.time->at(bytes), reading_.time_unit);
  Time after = 0;
  if (!time || __builtin_sub_overflow(*time, zero_, &after)) return false;
  if (after < -kMaxPointOffset || after > kMaxPointOffset) return false;
  point.time_offset_ns = static_cast<std::int32_t>(after);
  return true;
}

double CloudDecoder::ring(const std::byte* bytes, std::size_t index,
                          const LidarPoint& point) const {
  switch (reading_.ring_source) {
    case RingSource::kNone:
      return 0.0;
    case RingSource::kField:
      return columns_.ring ? columns_.ring->at(bytes) : 0.0;
    case RingSource::kRow:
      return static_cast<double>(index / table_.width);
    case RingSource::kColumn:
      return static_cast<double>(index % table_.width);
    case RingSource::kElevation:
      return ring_of_elevation(point.position, reading_.ring_elevations);
  }
  return 0.0;
}

std::vector<LidarPoint> CloudDecoder::points() {
  std::vector<LidarPoint> points;
  points.reserve(table_.size());
  int not_finite = 0, zero = 0, untimed = 0;
  for (std::size_t i = 0; i < table_.size(); ++i) {
    const std::byte* bytes = table_.point(i);
    LidarPoint point;
    point.position =
        Eigen::Vector3d(columns_.x.at(bytes), columns_.y.at(bytes), columns_.z.at(bytes))
            .cast<float>();
    if (!point.position.allFinite()) {
      ++not_finite;
      continue;
    }
    if (point.position.isZero(0.0F)) {
      ++zero;
      continue;
    }
    if (!read_time(bytes, point)) {
      ++untimed;
      continue;
    }
    const double number = ring(bytes, i, point);
    const double upwards =
        reading_.flipped_rings > 0 ? reading_.flipped_rings - 1 - number : number;
    point.ring = upwards > 0.0 ? static_cast<std::uint16_t>(std::min(upwards, 65535.0)) : 0;
    if (columns_.intensity) {
      const auto intensity = static_cast<float>(columns_.intensity->at(bytes));
      point.intensity = std::isfinite(intensity) ? intensity * reading_.intensity_scale : 0.0F;
    }
    points.push_back(point);
  }
  count("cloud_points_not_finite", not_finite);
  count("cloud_points_zero", zero);
  count("cloud_points_time_out_of_range", untimed);
  return points;
}

/// Times from azimuth: the first point fires at the start, a full turn takes the period.
void time_by_azimuth(const CloudReading& reading, std::vector<LidarPoint>& points) {
  if (points.empty()) return;
  const auto azimuth = [](const LidarPoint& point) {
    return std::atan2(static_cast<double>(point.position.y()),
                      static_cast<double>(point.position.x()));
  };
  const double start = azimuth(points.front());
  const double sense = reading.clockwise ? -1.0 : 1.0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    double turned = sense * (azimuth(points[i]) - start);
    turned -= kTurn * std::floor(turned / kTurn);
    if (turned > kTurn - kStartMargin && i < points.size() / 4) turned = 0.0;
    const double offset = turned / kTurn * static_cast<double>(reading.period);
    points[i].time_offset_ns = static_cast<std::int32_t>(std::llround(offset));
  }
}

bool fires_before(const LidarPoint& a, const LidarPoint& b) {
  return a.time_offset_ns < b.time_offset_ns;
}

}  // namespace

std::span<const std::string_view> time_field_names() {
  static constexpr std::array<std::string_view, 8> kNames = {
      "time",       "t",           "timestamp",  "time_offset",
      "timeOffset", "offset_time", "time_stamp", "offsetTime"};
  return kNames;
}

std::optional<Time> point_time(double value, double unit_ns) {
  const double ns = value * unit_ns;
  if (!(std::abs(ns) < 9e18)) return std::nullopt;
  if (std::abs(ns) < 1e15) return std::llround(ns);
  // Times since the epoch: integer and fractional part apart, so that no digit is lost.
  const double whole = std::floor(value);
  return static_cast<Time>(whole) * static_cast<Time>(unit_ns) +
         std::llround((value - whole) * unit_ns);
}

LidarScan read_cloud(const PointTable& table, const CloudReading& reading, EventCounts& counts) {
  LidarScan scan;
  scan.points = CloudDecoder(table, reading, counts).points();
  const bool timed = reading.clock != PointClock::kNone;
  if (timed && table.find(reading.time_field) == nullptr) ++counts["cloud_without_time"];
  if (!timed) time_by_azimuth(reading, scan.points);
  if (!std::is_sorted(scan.points.begin(), scan.points.end(), fires_before)) {
    ++counts["cloud_sorted_by_time"];
    std::stable_sort(scan.points.begin(), scan.points.end(), fires_before);
  }
  if (scan.points.empty()) ++counts["cloud_empty"];

  const bool ends_at_stamp = reading.stamp == CloudStamp::kEnd;
  const Time start = table.stamp - (ends_at_stamp ? reading.period : 0);
  const Time zero = reading.counted_from_start ? start : table.stamp;
  scan.stamp = start;
  scan.end = start + reading.period;
  if (scan.points.empty()) return scan;
  scan.stamp = std::min(start, zero + scan.points.front().time_offset_ns);
  scan.end = std::max(scan.end, zero + scan.points.back().time_offset_ns);
  const Duration shift = zero - scan.stamp;
  if (shift == 0) return scan;
  for (LidarPoint& point : scan.points) {
    point.time_offset_ns = static_cast<std::int32_t>(point.time_offset_ns + shift);
  }
  return scan;
}

}  // namespace aims
