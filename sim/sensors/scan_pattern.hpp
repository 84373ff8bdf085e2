// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <variant>
#include <vector>

#include "core/time.hpp"
#include "sim/sensors/lidar_config.hpp"

namespace aims {

/// Nominal length of one scan.
Duration scan_period(const LidarConfig& config);

/// Direction of a beam in the LiDAR frame.
struct BeamAngles {
  double azimuth = 0.0;    ///< from +x to +y [rad]
  double elevation = 0.0;  ///< [rad]

  Eigen::Vector3d direction() const;
};

/// One firing of a scan.
struct Firing {
  BeamAngles beam;              ///< as the sensor reports it
  double time_offset_ns = 0.0;  ///< after the scan's start [ns]
  int ring = 0;  ///< rank of its elevation among the channels, 0 lowest; of a rosette, its line
};

/// Rings that turn clockwise about the vertical axis, at fixed elevations.
struct SpinningPattern {
  struct Ring {
    double elevation = 0.0;       ///< [rad]
    double azimuth_offset = 0.0;  ///< from +x to +y [rad]
  };
  double start_azimuth = 0.0;  ///< of the first firing [rad]
  double period_ns = 0.0;      ///< of one turn, which is one scan [ns]
  std::vector<Ring> rings;     ///< ascending elevation

  BeamAngles beam(int ring, double time_offset_ns) const;
};

/// Beams behind rotating prisms: the angle from the z axis and the azimuth of a beam are the polar
/// coordinates of a sum of vectors, one per prism, which rotate, and the offset of its line.
struct RosettePattern {
  struct Prism {
    double deflection = 0.0;  ///< [rad]
    double rate = 0.0;        ///< [rad/s]
  };
  std::vector<Prism> prisms;
  std::vector<Eigen::Vector2d> line_offsets;  ///< [rad]

  /// The beam of a line at a time since the sensor was switched on.
  BeamAngles beam(int line, double time_s) const;
};

/// What a LiDAR fires when: columns of one firing per ring or line, each a fixed delay after its
/// column begins. Scan k begins k periods after time 0. A pure function of its arguments.
class ScanPattern {
 public:
  explicit ScanPattern(const LidarConfig& config);

  int lines() const { return static_cast<int>(delays_ns_.size()); }
  /// Whether every scan fires as the first one.
  bool repeats() const;
  /// Whether lines are rings, which keep their elevations.
  bool has_rings() const { return std::holds_alternative<SpinningPattern>(pattern_); }
  /// Lines in order of firing; of those that fire at once, as the datasheet lists the channels.
  const std::vector<int>& firing_order() const { return order_; }

  double column_period_ns() const { return column_ns_; }
  double delay_ns(int line) const { return delays_ns_[static_cast<std::size_t>(line)]; }
  /// Largest number of columns of a scan.
  int max_columns() const;
  /// A column that would not end within its scan is left out.
  int columns(std::int64_t scan) const;
  /// When the first column of a scan begins, after the scan's start [ns].
  double first_column_ns(std::int64_t scan) const;
  /// Angle between neighbouring firings of one line at the horizon, about [rad].
  double column_angle() const;

  Firing firing(std::int64_t scan, int column, int line) const;
  /// All firings of a scan in order of time.
  std::vector<Firing> firings(std::int64_t scan) const;

 private:
  std::variant<SpinningPattern, RosettePattern> pattern_;
  Duration period_;
  double column_ns_;               ///< between columns [ns]
  int columns_;                    ///< of every scan; 0: as many as fit into it
  std::vector<double> delays_ns_;  ///< by line [ns]
  std::vector<int> order_;
};

/// How the clouds of the sensor are recorded.
CloudFormat cloud_format(const LidarConfig& config);

}  // namespace aims
