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
/// So few points of a cloud may fire at one instant.
constexpr std::size_t kFewPoints = 100;
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

/// Points whose fields are read together, field by field.
constexpr std::size_t kBlock = 256;

/// The numbers of some points of one row of a cloud.
struct Block {
  std::size_t begin = 0;  ///< the first, among all points
  std::size_t count = 0;
  std::array<double, kBlock> x, y, z, time, ring, intensity;

  Eigen::Vector3f position(std::size_t i, double scale) const {
    return (scale * Eigen::Vector3d(x[i], y[i], z[i])).cast<float>();
  }
};

/// Reads the points of one cloud, with times relative to `zero`.
class CloudDecoder {
 public:
  CloudDecoder(const PointTable& table, const CloudReading& reading, EventCounts& counts)
      : table_(table), reading_(reading), counts_(counts), columns_(columns_of(table, reading)) {
    zero_ = zero();
  }

  std::vector<LidarPoint> points();

 private:
  Duration unwrapped(Duration after) const;
  Time zero() const;
  void read_fields(std::size_t begin, Block& block) const;
  bool read_time(double value, LidarPoint& point) const;
  double ring(const Block& block, std::size_t i, const LidarPoint& point) const;
  void read_block(const Block& block, std::vector<LidarPoint>& points);
  void count(const char* what, int times) {
    if (times > 0) counts_[what] += times;
  }

  const PointTable& table_;
  const CloudReading& reading_;
  EventCounts& counts_;
  Columns columns_;
  Time zero_ = 0;  ///< on the clock of the points' field
  int not_finite_ = 0, at_zero_ = 0, untimed_ = 0;
};

/// A difference of times of which the counter may have begun again at 0 in between.
Duration CloudDecoder::unwrapped(Duration after) const {
  const bool absolute =
      reading_.clock == PointClock::kOther || reading_.clock == PointClock::kEpoch;
  if (!absolute || !(reading_.time_wrap > 0.0) || table_.time_base) return after;
  const auto wrap = static_cast<Duration>(reading_.time_wrap);
  const Duration within = (after % wrap + wrap) % wrap;
  return within > wrap / 2 ? within - wrap : within;
}

/// Origin of the points' times, on the clock of their field.
Time CloudDecoder::zero() const {
  if (reading_.clock == PointClock::kEpoch) {
    return table_.time_base ? table_.stamp - *table_.time_base : table_.stamp;
  }
  if (reading_.clock != PointClock::kOther || !columns_.time) return 0;
  std::optional<Time> any;
  Duration first = 0;  // after that
  for (std::size_t i = 0; i < table_.size(); ++i) {
    const auto time = point_time(columns_.time->at(table_.point(i)), reading_.time_unit);
    Duration after = 0;
    if (!time || __builtin_sub_overflow(*time, any.value_or(*time), &after)) continue;
    if (!any) any = time;
    first = std::min(first, unwrapped(after));
  }
  return any.value_or(0) + first;
}

/// The fields of the points from `begin` on, within its row.
void CloudDecoder::read_fields(std::size_t begin, Block& block) const {
  block.begin = begin;
  block.count = std::min(kBlock, table_.width - begin % table_.width);
  const std::byte* const first = table_.point(begin);
  const auto read = [&](const std::optional<PointField>& field, std::array<double, kBlock>& to) {
    if (field) field->read(first, table_.point_step, std::span(to).first(block.count));
  };
  read(columns_.x, block.x);
  read(columns_.y, block.y);
  read(columns_.z, block.z);
  read(columns_.time, block.time);
  read(columns_.ring, block.ring);
  read(columns_.intensity, block.intensity);
}

bool CloudDecoder::read_time(double value, LidarPoint& point) const {
  const auto time = point_time(value, reading_.time_unit);
  Time after = 0;
  if (!time || __builtin_sub_overflow(*time, zero_, &after)) return false;
  after = unwrapped(after);
  if (after < -kMaxPointOffset || after > kMaxPointOffset) return false;
  point.time_offset_ns = static_cast<std::int32_t>(after);
  return true;
}

double CloudDecoder::ring(const Block& block, std::size_t i, const LidarPoint& point) const {
  switch (reading_.ring_source) {
    case RingSource::kNone:
      return 0.0;
    case RingSource::kField:
      return columns_.ring ? block.ring[i] : 0.0;
    case RingSource::kRow:
      return static_cast<double>((block.begin + i) / table_.width);
    case RingSource::kColumn:
      return static_cast<double>((block.begin + i) % table_.width);
    case RingSource::kElevation:
      return ring_of_elevation(point.position, reading_.ring_elevations);
  }
  return 0.0;
}

void CloudDecoder::read_block(const Block& block, std::vector<LidarPoint>& points) {
  for (std::size_t i = 0; i < block.count; ++i) {
    LidarPoint point;
    point.position = block.position(i, reading_.position_scale);
    if (!point.position.allFinite()) {
      ++not_finite_;
      continue;
    }
    if (point.position.isZero(0.0F)) {
      ++at_zero_;
      continue;
    }
    if (columns_.time && !read_time(block.time[i], point)) {
      ++untimed_;
      continue;
    }
    const double number = ring(block, i, point);
    const double upwards =
        reading_.flipped_rings > 0 ? reading_.flipped_rings - 1 - number : number;
    point.ring = upwards > 0.0 ? static_cast<std::uint16_t>(std::min(upwards, 65535.0)) : 0;
    if (columns_.intensity) {
      const auto intensity = static_cast<float>(block.intensity[i]);
      point.intensity = std::isfinite(intensity) ? intensity * reading_.intensity_scale : 0.0F;
    }
    points.push_back(point);
  }
}

std::vector<LidarPoint> CloudDecoder::points() {
  std::vector<LidarPoint> points;
  points.reserve(table_.size());
  Block block;
  for (std::size_t begin = 0; begin < table_.size(); begin += block.count) {
    read_fields(begin, block);
    read_block(block, points);
  }
  count("cloud_points_not_finite", not_finite_);
  count("cloud_points_zero", at_zero_);
  count("cloud_points_time_out_of_range", untimed_);
  count("cloud_mostly_untimed", static_cast<std::size_t>(untimed_) > points.size() ? 1 : 0);
  if (columns_.time && points.size() > kFewPoints) {
    const auto [first, last] = std::ranges::minmax(points, {}, &LidarPoint::time_offset_ns);
    count("cloud_without_times", first.time_offset_ns == last.time_offset_ns ? 1 : 0);
  }
  return points;
}

/// Times from azimuth: the first point fires at the start, a full turn takes that of the scan.
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
    const double offset = turned / kTurn * static_cast<double>(reading.scan_period());
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
