// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "estimator/baselines/features/feature_solver.hpp"
#include "estimator/filter/queued_estimator.hpp"
#include "estimator/interface/diagnostics.hpp"

namespace aims::features {

/// The series of the registration to the map, `Report::mapping`; NaN where a scan was not.
template <class Report>
constexpr std::array<ReportedSeries<Report>, 3> mapping_series() {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  return {{
      {"mapping_matches", "-", "lines and planes of the map; NaN: scan not registered",
       [](const Report& s) {
         return s.mapping ? double(s.mapping->lines + s.mapping->planes) : kNone;
       }},
      {"mapping_smallest_eigenvalue", "-",
       "smallest eigenvalue of A^T A in the first iteration, scan to map",
       [](const Report& s) { return s.mapping ? smallest_eigenvalue(*s.mapping) : kNone; }},
      {"mapping_removed_directions", "-", "degenerate directions that do not move",
       [](const Report& s) { return s.mapping ? double(s.mapping->directions.removed) : kNone; }},
  }};
}

/// What a system that segments its scans reports of each.
struct SegmentedReport {
  int points_in = 0;                    ///< returns in range
  int ground = 0;                       ///< returns of the ground
  int segmented = 0;                    ///< returns of kept segments
  std::optional<SolverResult> mapping;  ///< none: the scan was not registered to the map
  int loops = 0;                        ///< loops closed so far
};

/// The series of a segmented scan: `Report::points_in`, `ground` and `segmented`.
template <class Report>
constexpr std::array<ReportedSeries<Report>, 3> segmentation_series() {
  return {{
      {"points_in", "-", "finite points in range",
       [](const Report& s) { return double(s.points_in); }},
      {"ground_points", "-", "returns of the ground",
       [](const Report& s) { return double(s.ground); }},
      {"segmented_points", "-", "returns of kept segments",
       [](const Report& s) { return double(s.segmented); }},
  }};
}

/// The series of the loops, `Report::loops`.
template <class Report>
constexpr std::array<ReportedSeries<Report>, 1> loop_series() {
  return {{{"loops", "-", "loops closed so far", [](const Report& s) { return double(s.loops); }}}};
}

/// An estimator that reads scans, or scans and IMU, and reports a pose after each scan. The map is
/// in axes of the LiDAR, the odometry frame in those of the body.
class ScanEstimator : public QueuedEstimator {
 public:
  /// IMU samples are kept for `imu_memory`; 0: none is needed.
  ScanEstimator(const QueueConfig& queue, const SensorRig& rig, std::vector<SeriesInfo> series,
                Duration imu_memory = 0);

  std::vector<Eigen::Vector3f> map_points() const override;

 protected:
  /// Registers the scans in order of time; each call reports once at most.
  virtual void process(const LidarScan& scan) = 0;

  /// Points of the map, map axes [m].
  virtual std::vector<Eigen::Vector3f> points_in_lidar_axes() const = 0;

  /// Adds the pose of the LiDAR at the end of a scan, with the values of its series.
  void report(const Pose& T_map_lidar, Time end, std::vector<double> values);

  /// The samples of the IMU's memory.
  const ImuHistory& imu() const { return queue_.imu(); }

  /// Adds one to a count of the result.
  void count(const std::string& name) { ++result_.counts[name]; }

 private:
  void process_scan(const LidarScanPtr& scan) override { process(*scan); }
  void end_delivery() override;

  Duration imu_memory_;
};

}  // namespace aims::features
