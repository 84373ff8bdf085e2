// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>

#include "estimator/lidar/plane_model.hpp"
#include "estimator/lidar/voxel_store.hpp"

namespace aims {

/// Sums over the returns in a cube, enough for their plane and for whether they lie on one.
/// Positions are relative to the middle of the cube [m].
class PlaneSums {
 public:
  /// Adds a return; beyond kMaxCount nothing changes, so that the plane of an old place stays.
  void add(const Eigen::Vector3f& offset);

  int count() const { return count_; }

  /// The least-squares plane in a cube with this edge [m], its point relative to the middle; valid
  /// when principal_plane() says so, the quarters of the cube beside each other
  /// along the plane agree about it, and no side of the cube cuts off part of its returns.
  Plane plane(double edge) const;

  static constexpr int kMinCount = 20;
  static constexpr int kMaxCount = 400;

 private:
  struct Octant {
    int count = 0;
    Eigen::Vector3f sum = Eigen::Vector3f::Zero();
  };

  bool quarters_agree(const Plane& plane, double variance) const;

  int count_ = 0;
  Eigen::Vector3d sum_ = Eigen::Vector3d::Zero();
  Eigen::Matrix3d squares_ = Eigen::Matrix3d::Zero();
  std::array<Octant, 8> octants_;
};

/// Planes through all returns of a cubic cell, in two halves of the map. With hundreds of returns
/// over a metre a normal has less noise than one of five neighbours, and adds less noise-induced
/// information along a corridor (docs/estimators.md).
class PlaneGrid {
 public:
  explicit PlaneGrid(double edge) : edge_(static_cast<float>(edge)) {}

  void begin_insertion() { cells_.begin_insertion(); }

  /// Adds a finite return in the odometry frame to a half.
  void insert(const Eigen::Vector3f& point, std::size_t half);

  /// Fits the planes whose returns have changed.
  void end_insertion();

  /// The planes of both halves around `query`; invalid unless both are.
  PlanePair planes_at(const Eigen::Vector3f& query) const;

  /// As VoxelStore.
  void limit(std::size_t max_count, const Eigen::Vector3f& center);
  std::size_t memory() const { return cells_.memory(); }

 private:
  struct alignas(64) Cell {
    PlanePair planes;  ///< of the sums when they had `fitted` returns, odometry frame
    std::array<int, kHalves> fitted{};
    std::uint64_t key = 0;
    Eigen::Vector3f middle = Eigen::Vector3f::Zero();
    std::uint32_t seen = 0;
    std::array<PlaneSums, kHalves> sums;
  };

  float edge_;
  VoxelStore<Cell> cells_;
};

}  // namespace aims
