// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <span>
#include <vector>

#include "estimator/baselines/fast_lio2/config.hpp"
#include "estimator/lidar/voxel_hash.hpp"

namespace aims::fast_lio2 {

/// Neighbours of a point that a plane is fitted to.
inline constexpr int kNeighbours = 5;

/// The nearest map points of a query, nearest first.
struct Neighbours {
  int count = 0;  ///< kNeighbours unless the map has fewer points
  std::array<Eigen::Vector3f, kNeighbours> points;
  std::array<float, kNeighbours> squared_distances{};  ///< [m^2]
};

/// An axis-aligned box; a point on its upper faces is outside.
struct Box {
  Eigen::Vector3f min = Eigen::Vector3f::Zero();  ///< [m]
  Eigen::Vector3f max = Eigen::Vector3f::Zero();  ///< [m]

  bool contains(const Eigen::Vector3f& p) const {
    return (p.array() >= min.array()).all() && (p.array() < max.array()).all();
  }
};

/// The points of the map with the insertion rule of the incremental k-d tree of FAST-LIO2: of the
/// points in a voxel, the one nearest to its centre stays. A grid of cells of 4 x 4 x 4 voxels
/// replaces the tree; points and neighbours are the same.
class PointMap {
 public:
  /// `voxel`: edge [m].
  explicit PointMap(double voxel);

  bool empty() const { return size_ == 0; }
  std::size_t size() const { return size_; }

  /// Adds the point as it is.
  void add(const Eigen::Vector3f& point);

  /// Adds the point unless one in its voxel is as near to the voxel's centre; removes what else is
  /// in the voxel.
  void add_to_voxel(const Eigen::Vector3f& point);

  /// Removes the points in the box.
  void remove(const Box& box);

  /// The kNeighbours nearest points, whatever their distance.
  Neighbours nearest(const Eigen::Vector3f& query) const;

  /// Centre of the voxel that holds `point`.
  Eigen::Vector3f voxel_centre(const Eigen::Vector3f& point) const;

  /// Every point, cell by cell.
  std::vector<Eigen::Vector3f> points() const;

 private:
  using Cell = std::vector<Eigen::Vector3f>;

  Eigen::Array3i cell_index(const Eigen::Vector3f& point) const;
  Cell& cell_of(const Eigen::Vector3f& point);
  Box voxel_box(const Eigen::Vector3f& point) const;
  Neighbours nearest_of_all(const Eigen::Vector3f& query) const;
  void search_shell(const Eigen::Vector3f& query, const Eigen::Array3i& centre, int radius,
                    Neighbours& found) const;
  void search_cell(const Eigen::Vector3f& query, const Eigen::Array3i& index,
                   Neighbours& found) const;

  float voxel_;
  float cell_edge_;
  std::size_t size_ = 0;
  VoxelHash index_;                                  ///< of `cells_`
  std::vector<Cell> cells_;                          ///< may be empty after a removal
  Eigen::Array3i lowest_ = Eigen::Array3i::Zero();   ///< of the cells' indices
  Eigen::Array3i highest_ = Eigen::Array3i::Zero();  ///< likewise
};

/// Whether and how the map takes a point.
enum class Insertion {
  kNone,       ///< a neighbour is nearer to the centre of the point's voxel
  kVoxel,      ///< one point of the voxel stays
  kUnchecked,  ///< the nearest map point is outside the voxel along every axis
};

/// The decision for `point` (world), of which `neighbours` were found before its last correction.
Insertion insertion_of(const Eigen::Vector3f& point, const Neighbours& neighbours,
                       const PointMap& map, double voxel);

/// The cube around the LiDAR that the map keeps.
class LocalCube {
 public:
  explicit LocalCube(const Map& config) : config_(config) {}

  /// Moves the cube when the LiDAR at `position` (world) [m] comes near a face, and removes what
  /// it left behind from the map.
  void follow(const Eigen::Vector3d& position, PointMap& map);

 private:
  Map config_;
  std::optional<Box> cube_;
};

/// Inserts the points of a scan (world), each with its neighbours: first those that compete for
/// their voxel, then those that do not.
void insert_scan(std::span<const Eigen::Vector3f> points, std::span<const Neighbours> neighbours,
                 double voxel, PointMap& map);

}  // namespace aims::fast_lio2
