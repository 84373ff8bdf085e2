// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/baselines/features/feature_selection.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "estimator/lidar/voxel_hash.hpp"

namespace aims::features {

std::vector<FeatureCloud> ring_clouds(const LidarScan& scan, double min_range, double max_range) {
  std::vector<FeatureCloud> rings;
  const double duration = std::max(1.0, static_cast<double>(scan.end - scan.stamp));
  for (const LidarPoint& point : scan.points) {
    const double squared = point.position.cast<double>().squaredNorm();
    const bool in_range = squared >= min_range * min_range && squared <= max_range * max_range;
    if (!in_range || point.ring >= kMaxRings) continue;
    if (point.ring >= rings.size()) rings.resize(point.ring + 1U);
    const double fraction = std::clamp(point.time_offset_ns / duration, 0.0, 1.0);
    rings[point.ring].push_back({point.position, static_cast<float>(fraction), point.ring});
  }
  return rings;
}

FeatureCloud voxel_centroids(const FeatureCloud& cloud, double size) {
  FeatureCloud sums;
  std::vector<int> counts;
  VoxelHash voxels(cloud.size());
  const auto inverse_size = static_cast<float>(1.0 / size);
  for (const FeaturePoint& point : cloud) {
    const auto next = static_cast<std::int32_t>(sums.size());
    const std::int32_t slot =
        voxels.find_or_insert(voxel_key(voxel_of(point.position, inverse_size)), next);
    if (slot == next) {
      sums.push_back(point);
      counts.push_back(1);
      continue;
    }
    sums[slot].position += point.position;
    sums[slot].fraction += point.fraction;
    ++counts[slot];
  }
  for (std::size_t i = 0; i < sums.size(); ++i) {
    sums[i].position /= static_cast<float>(counts[i]);
    sums[i].fraction /= static_cast<float>(counts[i]);
  }
  return sums;
}

namespace {

/// The choice of features on one ring.
class Selection {
 public:
  Selection(const RingCandidates& ring, const SelectionConfig& config)
      : ring_(ring),
        config_(config),
        unavailable_(ring.unavailable),
        is_edge_(ring.points.size()) {}

  /// Points `begin` to `end`, without the last.
  void select_sector(int begin, int end, RingFeatures& features) {
    order_.clear();
    for (int i = begin; i < end; ++i) order_.push_back(i);
    std::sort(order_.begin(), order_.end(), [this](int a, int b) {
      return std::pair(ring_.curvature[a], a) < std::pair(ring_.curvature[b], b);
    });
    select_edges(features);
    select_flat(features);
    for (int i = begin; i < end; ++i) {
      if (!is_edge_[i]) less_flat_.push_back(ring_.points[i]);
    }
  }

  const FeatureCloud& less_flat() const { return less_flat_; }

 private:
  void select_edges(RingFeatures& features) {
    int count = 0;
    for (auto i = order_.rbegin(); i != order_.rend() && count < config_.max_less_sharp; ++i) {
      if (unavailable_[*i] || !ring_.may_be_edge[*i]) continue;
      if (ring_.curvature[*i] <= config_.curvature) continue;
      is_edge_[*i] = true;
      if (++count <= config_.max_sharp) features.sharp.push_back(ring_.points[*i]);
      features.less_sharp.push_back(ring_.points[*i]);
      exclude_neighbors(*i);
    }
  }

  void select_flat(RingFeatures& features) {
    int count = 0;
    for (auto i = order_.begin(); i != order_.end() && count < config_.max_flat; ++i) {
      if (unavailable_[*i] || !ring_.may_be_flat[*i]) continue;
      if (ring_.curvature[*i] >= config_.curvature) continue;
      ++count;
      features.flat.push_back(ring_.points[*i]);
      exclude_neighbors(*i);
    }
  }

  void exclude_neighbors(int chosen) {
    unavailable_[chosen] = true;
    for (int i = chosen; i < chosen + config_.half_window && ring_.joined[i]; ++i) {
      unavailable_[i + 1] = true;
    }
    for (int i = chosen; i > chosen - config_.half_window && ring_.joined[i - 1]; --i) {
      unavailable_[i - 1] = true;
    }
  }

  const RingCandidates& ring_;
  const SelectionConfig& config_;
  std::vector<bool> unavailable_;  ///< from the start, chosen, or beside a chosen point
  std::vector<bool> is_edge_;
  std::vector<int> order_;  ///< of the sector, by curvature
  FeatureCloud less_flat_;
};

}  // namespace

void describe(Fields& f, SelectionConfig& c) {
  f.integer(
      "half_window", c.half_window,
      {"-", in_range(1, 50), "ring neighbours on each side in the curvature", "LOAM, eq. (1)"});
  f.integer("sectors", c.sectors, {"-", in_range(1, 100), "parts of a ring with equal returns"});
  f.integer("max_sharp", c.max_sharp, {"-", in_range(0, 1000), "sharp edges per sector at most"});
  f.integer("max_less_sharp", c.max_less_sharp,
            {"-", in_range(0, 1000), "edges per sector at most, the sharp ones among them"});
  f.integer("max_flat", c.max_flat, {"-", in_range(0, 1000), "flat points per sector at most"});
  f.number("curvature", c.curvature,
           {"m^2", positive_up_to(1e6), "edges have more curvature, flat points less"});
  f.number("less_flat_voxel", c.less_flat_voxel,
           {"m", in_range(0.01, 10.0), "less flat points are averaged in such voxels, per ring"});
}

void select_features(const RingCandidates& ring, const SelectionConfig& config,
                     RingFeatures& features) {
  const int begin = config.half_window;
  const int end = static_cast<int>(ring.points.size()) - config.half_window - 1;
  if (end - begin < config.sectors) return;
  Selection selection(ring, config);
  for (int j = 0; j < config.sectors; ++j) {
    selection.select_sector(begin + (end - begin) * j / config.sectors,
                            begin + (end - begin) * (j + 1) / config.sectors, features);
  }
  const FeatureCloud centroids = voxel_centroids(selection.less_flat(), config.less_flat_voxel);
  features.less_flat.insert(features.less_flat.end(), centroids.begin(), centroids.end());
}

}  // namespace aims::features
