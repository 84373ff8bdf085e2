// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "estimator/lidar/four_points.hpp"

namespace aims {

/// The nearest return of a scan in each direction: pixels of 1 deg of azimuth and 0.05 of the sine
/// of the elevation (2.9 deg at the horizon), so that rings 2 deg apart leave no row empty. Points
/// are relative to the sensor, in axes whose z points up.
class RangeImage {
 public:
  RangeImage();

  /// Replaces the image by that of `points`.
  void fill(const PointBlocks& points);

  /// The nearest point of each pixel that has one.
  const PointBlocks& nearest() const { return nearest_; }

  /// Bit i: whether the scan passed point i by at least `margin` [m]: all returns of its pixel and
  /// of the eight around it lie farther. Then an edge beside the point, or a wall at grazing
  /// incidence whose range changes within a pixel, does not count. False where too few pixels have
  /// returns.
  unsigned passed(const FourPoints& points, float margin) const;

  /// Whether the scan has a return within `tolerance` [m] of the point's range in its pixel or in
  /// one of the eight around it.
  bool confirms(const Eigen::Vector3f& point, float tolerance) const;

 private:
  static constexpr int kColumns = 360;
  static constexpr int kRows = 40;
  /// The image goes on beyond its borders by a pixel: around the circle, and empty above and below.
  static constexpr int kStride = kColumns + 2;
  static constexpr std::size_t kPixels = static_cast<std::size_t>(kStride * (kRows + 2));

  static Int4 pixels_of(const FourPoints& points, Float4 ranges);
  void list_nearest(const PointBlocks& points);
  void wrap_around();
  void find_around();

  std::vector<float> ranges_;        ///< infinity: no return [m]
  std::vector<float> around_;        ///< nearest of 3 x 3 pixels; 0: too few have returns [m]
  std::vector<std::int32_t> index_;  ///< of the return, for a pixel with one
  PointBlocks nearest_;
};

}  // namespace aims
