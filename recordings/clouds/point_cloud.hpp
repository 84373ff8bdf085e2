// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "core/lidar_rings.hpp"
#include "core/measurements.hpp"
#include "recordings/clouds/point_table.hpp"
#include "recordings/clouds/turn_parts.hpp"
#include "recordings/event_counts.hpp"
#include "recordings/recording_config.hpp"

namespace aims {

/// Where the firing time of a point comes from.
enum class PointClock {
  kNone,   ///< derived from its azimuth and the spin
  kStamp,  ///< its field, relative to the cloud's stamp
  kEpoch,  ///< its field, on the clock of the stamps
  kOther,  ///< its field, on another clock: only differences are used
};

/// Where the ring of a point comes from.
enum class RingSource { kNone, kField, kRow, kColumn, kElevation };

/// How the clouds of a recording are read.
struct CloudReading {
  PointClock clock = PointClock::kNone;
  std::string time_field;
  double time_unit = 1.0;                 ///< of that field [ns]
  double time_wrap = 0.0;                 ///< where a counter begins again; 0: nowhere [ns]
  bool normalized_times = false;          ///< the unit is the scan: from 0 to 1 or -1 to 0
  CloudStamp stamp = CloudStamp::kStart;  ///< never kAuto
  bool counted_from_start = true;         ///< times begin with the scan, not at the stamp
  Duration period = 100 * kMillisecond;   ///< nominal, of one cloud
  Duration spacing = 0;                   ///< of clouds where none is lost; 0: not known
  TurnParts parts;                        ///< of clouds that are no whole scans
  bool clockwise = true;                  ///< direction of spin, for kNone
  RingSource ring_source = RingSource::kNone;
  std::string ring_field;
  int flipped_rings = 0;                ///< > 0: number of rings, of which ring 0 is the highest
  LidarRings rings;                     ///< none where rings are derived, or are lines
  std::vector<double> ring_elevations;  ///< ascending, for kElevation [rad]
  double position_scale = 1.0;          ///< of the coordinates to metres
  std::string intensity_field;          ///< empty: none
  float intensity_scale = 1.0F;         ///< scales it to [0, 1]

  /// Nominal, of one scan.
  Duration scan_period() const { return period * parts.count; }
};

/// The points in firing order, each with its own time. A point that is not finite, at the origin,
/// or more than a second from the stamp is dropped and counted. `table` is valid.
LidarScan read_cloud(const PointTable& table, const CloudReading& reading, EventCounts& counts);

/// Names of a point's time field in known drivers.
std::span<const std::string_view> time_field_names();

/// A field value as a time [ns]; nothing when it is out of range.
std::optional<Time> point_time(double value, double unit_ns);

}  // namespace aims
