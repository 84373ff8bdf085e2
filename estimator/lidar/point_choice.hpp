// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <tuple>
#include <vector>

#include "core/measurements.hpp"

namespace aims {

/// One return of every `every_nth`, in order of firing, that is further than `min_range` [m], as
/// indices into `scan`.
std::vector<int> chosen_points(const LidarScan& scan, int every_nth, double min_range);

/// The centroid of the points in each voxel of edge `voxel` [m], in order of z, y, x of the voxels.
/// A point is a vector of single precision; its entries after the position are averaged as well.
template <class Point>
std::vector<Point> voxel_centroids(const std::vector<Point>& points, double voxel) {
  struct Entry {
    std::tuple<int, int, int> key;  ///< z, y, x
    int index = 0;
  };
  const auto inverse = static_cast<float>(1.0 / voxel);
  std::vector<Entry> entries;
  entries.reserve(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Array3i at =
        (points[i].template head<3>().array() * inverse).floor().template cast<int>();
    entries.push_back({{at.z(), at.y(), at.x()}, static_cast<int>(i)});
  }
  std::ranges::stable_sort(entries, {}, &Entry::key);
  std::vector<Point> centroids;
  for (std::size_t begin = 0; begin < entries.size();) {
    Point sum = Point::Zero();
    std::size_t end = begin;
    for (; end < entries.size() && entries[end].key == entries[begin].key; ++end) {
      sum += points[static_cast<std::size_t>(entries[end].index)];
    }
    centroids.push_back(sum / static_cast<float>(end - begin));
    begin = end;
  }
  return centroids;
}

}  // namespace aims
