// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/baselines/features/point_index.hpp"

#include <array>
#include <cassert>
#include <nanoflann.hpp>
#include <utility>

namespace aims::features {
namespace {

/// Most neighbours of one query.
constexpr std::size_t kMaxNeighbors = 16;

/// Points per leaf of the tree: fewer make it slower to build, more slower to search.
constexpr std::size_t kLeafSize = 15;

struct Points {
  std::vector<Eigen::Vector3f> values;

  std::size_t kdtree_get_point_count() const { return values.size(); }
  float kdtree_get_pt(std::size_t index, std::size_t axis) const {
    return values[index][static_cast<Eigen::Index>(axis)];
  }
  template <class Box>
  bool kdtree_get_bbox(Box&) const {
    return false;
  }
};

using KdTree =
    nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<float, Points>, Points, 3>;

}  // namespace

struct PointIndex::Tree {
  Points points;
  std::unique_ptr<KdTree> index;
};

PointIndex::PointIndex() : tree_(std::make_unique<Tree>()) {}
PointIndex::~PointIndex() = default;

void PointIndex::build(std::vector<Eigen::Vector3f> points) {
  tree_->points.values = std::move(points);
  tree_->index.reset();
  if (tree_->points.values.empty()) return;
  tree_->index = std::make_unique<KdTree>(3, tree_->points,
                                          nanoflann::KDTreeSingleIndexAdaptorParams(kLeafSize));
}

std::size_t PointIndex::nearest(const Eigen::Vector3f& query, std::span<Neighbor> neighbors) const {
  assert(neighbors.size() <= kMaxNeighbors);
  if (!tree_->index) return 0;
  std::array<std::size_t, kMaxNeighbors> indices;
  std::array<float, kMaxNeighbors> distances;
  nanoflann::KNNResultSet<float> found(neighbors.size());
  found.init(indices.data(), distances.data());
  tree_->index->findNeighbors(found, query.data(), nanoflann::SearchParams());
  for (std::size_t i = 0; i < found.size(); ++i) {
    neighbors[i] = {static_cast<int>(indices[i]), distances[i]};
  }
  return found.size();
}

const std::vector<Eigen::Vector3f>& PointIndex::points() const { return tree_->points.values; }

std::vector<Eigen::Vector3f> positions_of(const FeatureCloud& cloud) {
  std::vector<Eigen::Vector3f> positions;
  positions.reserve(cloud.size());
  for (const FeaturePoint& point : cloud) positions.push_back(point.position);
  return positions;
}

}  // namespace aims::features
