// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "core/measurements.hpp"
#include "core/trajectory.hpp"
#include "sim/environment/ray_caster.hpp"

namespace aims {

/// A range against the true surface in the reported direction of its point.
struct RangeResidual {
  double range = 0.0;     ///< true [m]
  double cosine = 0.0;    ///< of the angle between beam and normal, in (0, 1]
  double residual = 0.0;  ///< measured minus true range [m]; infinite: there is no surface
};

/// One residual per point of the scan, in order. `T_world_lidar` are the true poses of the LiDAR;
/// where they do not cover a firing, the first or last holds. People are where they truly are.
std::vector<RangeResidual> range_residuals(const LidarScan& scan, const Trajectory& T_world_lidar,
                                           const RayCaster& caster);

/// Residuals of one bin of range and incidence.
struct ResidualBin {
  double range_begin = 0.0;          ///< [m]
  double range_end = 0.0;            ///< [m]
  double incidence_begin_deg = 0.0;  ///< 0: perpendicular [deg]
  double incidence_end_deg = 0.0;    ///< [deg]
  int returns = 0;
  /// Of the residuals within 10 cm: mixed pixels and edges would hide the noise [m].
  double mean = 0.0;
  double std = 0.0;           ///< as `mean` [m]
  double share_beyond = 0.0;  ///< of the returns: residual beyond 10 cm [-]
};

/// Bins over ranges 0-1-2-5-10-20-50-100 m and incidences 0-30-60-75-85-90 deg; empty bins are
/// left out.
std::vector<ResidualBin> residual_bins(const std::vector<RangeResidual>& residuals);

}  // namespace aims
