// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <span>
#include <vector>

#include "core/measurements.hpp"
#include "estimator/filter/error_state.hpp"
#include "estimator/filter/imu_propagation.hpp"
#include "estimator/lidar/four_points.hpp"

namespace aims {

/// Motion of the LiDAR during a scan, relative to the body at the scan's end.
class ScanMotion {
 public:
  /// Propagates `end_state`, the state at the last segment's end, backward through `segments`
  /// (consecutive, oldest first).
  void assign(const NominalState& end_state, std::span<const InertialSegment> segments,
              const Pose& T_body_lidar, double gravity);

  /// Transforms a point fired at `time` from LiDAR coordinates at that time to body coordinates at
  /// the scan's end. Times outside the segments are clamped.
  Eigen::Vector3f deskew(const Eigen::Vector3f& point, Time time) const;

 private:
  /// Columns of R and t, each with a fourth entry without use.
  struct Knot {
    std::array<Float4, 3> R;
    Float4 t;

    Float4 apply(const Eigen::Vector3f& p) const {
      return R[0] * p.x() + R[1] * p.y() + R[2] * p.z() + t;
    }
  };

  static Knot knot(const Pose& T_end_lidar);

  Time begin_ = 0;
  std::vector<Knot> knots_;  ///< T_bodyend_lidar every millisecond from begin_, the end included
};

/// Deskews the points of `scan` at `indices` into `points`.
void deskew(const LidarScan& scan, std::span<const int> indices, const ScanMotion& motion,
            std::vector<Eigen::Vector3f>& points);

/// The same, in blocks.
void deskew(const LidarScan& scan, std::span<const int> indices, const ScanMotion& motion,
            PointBlocks& points);

}  // namespace aims
