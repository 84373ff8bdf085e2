// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <memory>
#include <span>
#include <vector>

#include "estimator/baselines/features/feature_point.hpp"

namespace aims::features {

/// A map point and its squared distance from the query [m^2].
struct Neighbor {
  int index = 0;
  float squared_distance = 0.0F;
};

/// A k-d tree over points, for nearest neighbours.
class PointIndex {
 public:
  PointIndex();
  ~PointIndex();
  PointIndex(const PointIndex&) = delete;
  PointIndex& operator=(const PointIndex&) = delete;

  /// Builds the tree of the points, replacing any other.
  void build(std::vector<Eigen::Vector3f> points);

  /// The nearest points in order of distance, as many as `neighbors` holds or as there are;
  /// returns how many.
  std::size_t nearest(const Eigen::Vector3f& query, std::span<Neighbor> neighbors) const;

  const std::vector<Eigen::Vector3f>& points() const;

 private:
  struct Tree;
  std::unique_ptr<Tree> tree_;
};

/// The positions of a cloud [m].
std::vector<Eigen::Vector3f> positions_of(const FeatureCloud& cloud);

}  // namespace aims::features
