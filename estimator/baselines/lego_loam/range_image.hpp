// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "core/config.hpp"
#include "core/measurements.hpp"
#include "estimator/baselines/features/feature_selection.hpp"

namespace aims::lego_loam {

/// Firing times from azimuths, as the published program has them: a rule for returns in firing
/// order, applied to returns in order of columns. With a turn that begins behind the robot, all
/// rings but the lowest get the first quarter of the turn as a fifth one, 1 to 1.25 instead of 0 to
/// 0.25, and the lowest ring gets the last quarter as -0.25 to 0, too.
class AzimuthTimes {
 public:
  /// Azimuths of the first and of the last return of the scan [rad]; the LiDAR turns clockwise.
  AzimuthTimes(double first_azimuth, double last_azimuth);

  /// The time of the next return, as a fraction of the scan.
  double next(double azimuth);

 private:
  double start_;  ///< orientation, clockwise [rad]
  double end_;
  bool half_passed_ = false;
};

/// Range image, ground and segments (Shan and Englot, LeGO-LOAM, IROS 2018, section III-B).
struct RangeImageConfig {
  double min_range = 1.0;           ///< nearer returns are ignored [m]
  double max_range = 200.0;         ///< farther returns are ignored [m]
  int rows = 16;                    ///< one per ring
  int columns = 1800;               ///< of one turn
  double row_angle_deg = 2.0;       ///< between two rings [deg]
  int ground_rows = 7;              ///< pairs of rings from the lowest that may see the ground
  double ground_slope_deg = 10.0;   ///< steepest ground between two rings [deg]
  double segment_angle_deg = 60.0;  ///< neighbours of a larger angle are one object [deg]
  int large_segment = 30;           ///< returns of a segment that is kept however thin
  int small_segment = 5;            ///< returns of a segment that is kept if it spans rings
  int small_segment_rows = 3;       ///< rings that it spans
  int stride = 5;                   ///< one column in this many keeps ground and outliers
};

void describe(Fields& fields, RangeImageConfig& config);

/// Azimuth of a point, from +x to +y [rad].
double azimuth_of(const Eigen::Vector3f& position);

/// What a cell of the range image shows.
enum class CellKind : std::uint8_t { kEmpty, kUnlabelled, kGround, kSegment, kOutlier };

/// Returns of a scan by ring and azimuth; columns follow the azimuth, the first is at -180 degrees.
class RangeImage {
 public:
  RangeImage(const LidarScan& scan, const RangeImageConfig& config);

  int rows() const { return config_.rows; }
  int columns() const { return config_.columns; }
  /// Returns in range.
  int count() const { return count_; }
  CellKind kind(int row, int column) const { return kinds_[cell(row, column)]; }
  /// Of a cell that is not empty, LiDAR axes.
  const features::FeaturePoint& point(int row, int column) const {
    return points_[cell(row, column)];
  }
  float range(int row, int column) const { return ranges_[cell(row, column)]; }  ///< [m]
  double first_azimuth() const { return first_azimuth_; }  ///< of the scan's first return [rad]
  double last_azimuth() const { return last_azimuth_; }    ///< of its last return [rad]

 private:
  /// An angle from 0 to 90 degrees.
  struct Angle {
    explicit Angle(double degrees);
    /// Whether it is less than that of a triangle with these sides at the right angle.
    bool less_than(double opposite, double adjacent) const;

    double sine;
    double cosine;
  };

  std::size_t cell(int row, int column) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(config_.columns) +
           static_cast<std::size_t>(column);
  }
  void project(const LidarScan& scan);
  void label_ground();
  bool level(int row, int column) const;
  void label_segments();
  void grow_segment(int row, int column);
  void visit_neighbors(std::size_t from, std::vector<std::size_t>& segment);
  bool same_object(std::size_t a, std::size_t b, const Angle& between) const;
  bool is_segment(const std::vector<std::size_t>& cells) const;

  RangeImageConfig config_;
  Angle column_angle_;
  Angle row_angle_;
  Angle segment_angle_;
  Angle ground_slope_;
  int count_ = 0;
  double first_azimuth_ = 0.0;
  double last_azimuth_ = 0.0;
  std::vector<features::FeaturePoint> points_;
  std::vector<float> ranges_;
  std::vector<CellKind> kinds_;
};

}  // namespace aims::lego_loam
