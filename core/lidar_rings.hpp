// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace aims {

/// The rings of a LiDAR whose returns state them: beams that keep their elevations.
struct LidarRings {
  int count = 0;             ///< 0: none, or lines that are no rings
  double spacing_deg = 0.0;  ///< mean angle between neighbours [deg]
};

}  // namespace aims
