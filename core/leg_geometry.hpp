// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace aims {

class Fields;

/// Dimensions of a quadruped [m].
struct LegGeometry {
  double hip_x = 0.0;      ///< hip from the trunk's centre, forward or back
  double hip_y = 0.0;      ///< hip from the trunk's centre, to either side
  double abduction = 0.0;  ///< from the abduction axis to the plane of the leg
  double thigh = 0.0;
  double calf = 0.0;
  double foot_radius = 0.0;

  bool operator==(const LegGeometry&) const = default;
};

void describe(Fields& fields, LegGeometry& geometry);

}  // namespace aims
