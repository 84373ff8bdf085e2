// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/config.hpp"
#include "core/measurements.hpp"
#include "estimator/baselines/features/ring_features.hpp"

namespace aims::lio_sam {

/// How far beyond a scan its samples reach, on both sides.
inline constexpr Duration kSampleMargin = 10 * kMillisecond;

/// Rotation during a scan from the gyro alone. Rates are summed up axis by axis and taken as roll,
/// pitch and yaw, as in the published program: exact only for small rotations.
class GyroRotation {
 public:
  /// Samples up to `end` in order of stamp; the first one is where the angles are zero.
  GyroRotation(const std::vector<ImuSample>& samples, Time end);

  /// Whether there are two samples, so that anything is known.
  bool available() const { return stamps_.size() > 1; }

  /// Angles about x, y and z at a time, linear between samples, constant outside [rad].
  Eigen::Vector3d angles_at(Time stamp) const;

  /// R_first_time with these angles.
  Eigen::Matrix3f rotation_at(Time stamp) const;

 private:
  std::vector<Time> stamps_;
  std::vector<Eigen::Vector3d> angles_;
};

/// Range image of a scan: one row per ring.
struct ImageConfig {
  double min_range = 1.0;     ///< nearer returns are ignored [m]
  double max_range = 1000.0;  ///< farther returns are ignored [m]
  int columns = 1800;         ///< cells of one turn, of which each keeps its first return
};

void describe(Fields& fields, ImageConfig& config);

/// Edges and surfaces; defaults of the published program.
struct FeatureConfig {
  int half_window = 5;          ///< ring neighbours on each side that the curvature sums
  int sectors = 6;              ///< of equal numbers of returns, per ring
  int max_edges = 20;           ///< per sector
  double edge_curvature = 1.0;  ///< edges have more [m^2]
  double flat_curvature = 0.1;  ///< flat points, beside which there is no edge, have less [m^2]
  double surface_voxel = 0.4;   ///< surfaces are averaged in voxels of it, per ring [m]
  features::RangeRingConfig reliability;
};

void describe(Fields& fields, FeatureConfig& config);

/// The returns in range, ring by ring, each turned to the axes of the first one used by the gyro's
/// rotation; translation during the scan is left out. Ranges are as measured.
std::vector<features::RangeRing> deskewed_rings(const LidarScan& scan, const GyroRotation& rotation,
                                                const ImageConfig& config);

struct ScanFeatures {
  int points = 0;                  ///< in the image
  features::FeatureCloud edges;    ///< LiDAR axes at the begin of the scan
  features::FeatureCloud surface;  ///< likewise, all that is no edge
};

/// Curvature of return i: c_i = (sum over ring neighbours of (r_j - r_i))^2 with ranges r [m^2].
ScanFeatures scan_features(const std::vector<features::RangeRing>& rings,
                           const FeatureConfig& config);

}  // namespace aims::lio_sam
