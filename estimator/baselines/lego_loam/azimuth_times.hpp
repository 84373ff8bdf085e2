// SPDX-License-Identifier: BSD-3-Clause
#pragma once

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

}  // namespace aims::lego_loam
