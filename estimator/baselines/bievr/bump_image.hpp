// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "estimator/baselines/bievr/config.hpp"

namespace aims::bievr {

/// A point to map.
struct MapPoint {
  Eigen::Vector3d p_world = Eigen::Vector3d::Zero();  ///< [m]
  double range = 0.0;                                 ///< from the sensor [m]
};

/// Height of a surface over the plane of its image.
struct Height {
  double value = 0.0;                               ///< [m]
  Eigen::Vector2d slope = Eigen::Vector2d::Zero();  ///< along the axes of the image [-]
};

/// An image of heights over a plane, spanned by its axes x and y. The centre of the pixel in a
/// column and a row lies at (column, row) times the edge of a pixel.
class BumpImage {
 public:
  BumpImage() = default;
  /// Empty, over the plane through `p_world` with the unit normal `normal`, large enough for the
  /// voxel whose lowest corner is `corner` [m].
  BumpImage(const Eigen::Vector3d& p_world, const Eigen::Vector3d& normal,
            const Eigen::Vector3d& corner, const MapConfig& config);

  /// A point of the world in the axes of the image [m]; z: over its plane.
  Eigen::Vector3d in_image(const Eigen::Vector3d& p_world) const { return R_ * p_world + t_; }
  /// R_image_world; its last row is the normal.
  const Eigen::Matrix3d& R_image_world() const { return R_; }

  /// A point over its pixel: the height is the weighted mean.
  void add(const Eigen::Vector3d& p_world, float weight);
  /// The pixels of another image, as one point each; it replaces what a pixel has.
  void project(const BumpImage& other);
  /// Averages the heights over 3 x 3 pixels of those that have points, or takes them as they are.
  void smooth(bool enabled);

  /// The smoothed height, bilinear between the pixels that have points, at `at` in the axes of the
  /// image [m]; none outside or where the four pixels have no points. The slope is the difference
  /// over two pixels; 0 where it has none.
  std::optional<Height> sample(const Eigen::Vector2d& at) const;
  /// Its value alone.
  std::optional<double> height(const Eigen::Vector2d& at) const;

  /// How much relief it has: the mean absolute height; 0 with fewer than five pixels [m].
  double relief() const;
  /// The centre of each pixel that has points [m, world].
  void append_points(std::vector<Eigen::Vector3f>& points) const;

 private:
  bool inside(int column, int row) const;
  std::size_t index(int column, int row) const;
  float smoothed_at(int column, int row) const;
  Eigen::Vector3d in_world(int column, int row) const;
  std::optional<double> between(int column, int row, const Eigen::Vector2d& fraction) const;

  double pixel_ = 1.0;                               ///< edge [m]
  Eigen::Matrix3d R_ = Eigen::Matrix3d::Identity();  ///< R_image_world
  Eigen::Vector3d t_ = Eigen::Vector3d::Zero();      ///< image coordinates of the world's origin
  int columns_ = 0;
  int rows_ = 0;
  std::vector<float> heights_;   ///< row by row [m]
  std::vector<float> smoothed_;  ///< likewise
  std::vector<float> weights_;   ///< 0: no points
};

/// A voxel of the map and its surface.
struct BumpVoxel {
  std::uint64_t key = 0;
  std::uint32_t seen = 0;  ///< insertion that touched it last
  bool observed = false;   ///< whether there is a plane and an image
  std::int64_t count = 0;  ///< of all points so far
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  Eigen::Matrix3d outer_sum = Eigen::Matrix3d::Zero();
  std::vector<MapPoint> pending;  ///< before there is a plane
  BumpImage image;
  double relief = 0.0;  ///< of the image [m]

  Eigen::Vector3d centroid() const { return sum / static_cast<double>(count); }

  /// Adds points of this voxel, whose lowest corner is `corner` [m]. The plane is that of all
  /// points so far, once there are four; where its normal has turned beyond the tolerance, the
  /// image is projected into a new one.
  void add(std::span<const MapPoint> points, const Eigen::Vector3d& corner,
           const MapConfig& config);
};

}  // namespace aims::bievr
