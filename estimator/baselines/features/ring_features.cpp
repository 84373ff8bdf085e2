// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/baselines/features/ring_features.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace aims::features {
namespace {

enum class Label { kLessFlat, kLessSharp, kSharp };

float squared_gap(const FeatureCloud& ring, int a, int b) {
  return (ring[a].position - ring[b].position).squaredNorm();
}

/// Whether the nearer of two returns hides part of the surface of the farther: on the circle of the
/// nearer one their beams are close.
bool occludes(const Eigen::Vector3f& near, const Eigen::Vector3f& far, double ratio) {
  const float range = near.norm();
  return (near - far * (range / far.norm())).norm() / range < ratio;
}

/// The choice of features on one ring.
class RingSelection {
 public:
  RingSelection(const FeatureCloud& ring, const RingFeatureConfig& config)
      : ring_(ring),
        config_(config),
        curvature_(ring_curvature(ring, config.half_window)),
        unavailable_(config.reject_unreliable ? unreliable_points(ring, config)
                                              : std::vector<bool>(ring.size())),
        labels_(ring.size(), Label::kLessFlat) {}

  /// Points `begin` to `end`, without the last.
  void select_sector(int begin, int end, RingFeatures& features) {
    order_.clear();
    for (int i = begin; i < end; ++i) order_.push_back(i);
    std::sort(order_.begin(), order_.end(), [this](int a, int b) {
      return std::pair(curvature_[a], a) < std::pair(curvature_[b], b);
    });
    select_edges(features);
    select_flat(features);
    for (int i = begin; i < end; ++i) {
      if (labels_[i] == Label::kLessFlat) less_flat_.push_back(ring_[i]);
    }
  }

  const FeatureCloud& less_flat() const { return less_flat_; }

 private:
  void select_edges(RingFeatures& features) {
    int count = 0;
    for (auto i = order_.rbegin(); i != order_.rend() && count < config_.max_less_sharp; ++i) {
      if (unavailable_[*i] || curvature_[*i] <= config_.curvature) continue;
      const bool sharp = ++count <= config_.max_sharp;
      labels_[*i] = sharp ? Label::kSharp : Label::kLessSharp;
      if (sharp) features.sharp.push_back(ring_[*i]);
      features.less_sharp.push_back(ring_[*i]);
      exclude_neighbors(*i);
    }
  }

  void select_flat(RingFeatures& features) {
    int count = 0;
    for (auto i = order_.begin(); i != order_.end() && count < config_.max_flat; ++i) {
      if (unavailable_[*i] || curvature_[*i] >= config_.curvature) continue;
      ++count;
      features.flat.push_back(ring_[*i]);
      exclude_neighbors(*i);
    }
  }

  void exclude_neighbors(int chosen) {
    unavailable_[chosen] = true;
    for (const int step : {1, -1}) {
      for (int n = 1; n <= config_.half_window; ++n) {
        const int i = chosen + step * n;
        if (squared_gap(ring_, i, i - step) > config_.max_gap_squared) break;
        unavailable_[i] = true;
      }
    }
  }

  const FeatureCloud& ring_;
  const RingFeatureConfig& config_;
  std::vector<float> curvature_;
  std::vector<bool> unavailable_;  ///< rejected, chosen, or beside a chosen point
  std::vector<Label> labels_;
  std::vector<int> order_;  ///< of the sector, by curvature
  FeatureCloud less_flat_;
};

void select_ring(const FeatureCloud& ring, const RingFeatureConfig& config,
                 RingFeatures& features) {
  const int begin = config.half_window;
  const int end = static_cast<int>(ring.size()) - config.half_window - 1;
  if (end - begin < config.sectors) return;
  RingSelection selection(ring, config);
  for (int j = 0; j < config.sectors; ++j) {
    selection.select_sector(begin + (end - begin) * j / config.sectors,
                            begin + (end - begin) * (j + 1) / config.sectors, features);
  }
  const FeatureCloud centroids = voxel_centroids(selection.less_flat(), config.less_flat_voxel);
  features.less_flat.insert(features.less_flat.end(), centroids.begin(), centroids.end());
}

}  // namespace

void describe(Fields& f, RingFeatureConfig& c) {
  f.number("min_range", c.min_range, {"m", up_to(1e4), "nearer returns are ignored"});
  f.number("max_range", c.max_range, {"m", positive_up_to(1e4), "farther returns are ignored"});
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
  f.number("max_gap_squared", c.max_gap_squared,
           {"m^2", up_to(1e6), "neighbours of a feature up to a larger gap are not chosen"});
  f.number("less_flat_voxel", c.less_flat_voxel,
           {"m", in_range(0.01, 10.0), "less flat points are averaged in such voxels, per ring"});
  f.flag("reject_unreliable", c.reject_unreliable,
         {"", any(), "reject returns at occlusions and on nearly parallel surfaces"});
  f.number("occlusion_gap_squared", c.occlusion_gap_squared,
           {"m^2", up_to(1e6), "smaller gaps between returns are no occlusion"});
  f.number("occlusion_ratio", c.occlusion_ratio,
           {"-", up_to(10.0), "lateral gap over range; gaps with less are occlusions"});
  f.number("parallel_ratio", c.parallel_ratio,
           {"-", up_to(10.0), "squared gaps over squared range; more is a parallel surface"});
  f.idle_if(!c.reject_unreliable, "reject_unreliable is false",
            {"occlusion_gap_squared", "occlusion_ratio", "parallel_ratio"});
}

std::vector<float> ring_curvature(const FeatureCloud& ring, int half_window) {
  const int count = static_cast<int>(ring.size());
  std::vector<float> curvature(ring.size(), 0.0F);
  for (int i = half_window; i < count - half_window; ++i) {
    Eigen::Vector3f sum = -2.0F * static_cast<float>(half_window) * ring[i].position;
    for (int j = 1; j <= half_window; ++j) sum += ring[i - j].position + ring[i + j].position;
    curvature[i] = sum.squaredNorm();
  }
  return curvature;
}

std::vector<bool> unreliable_points(const FeatureCloud& ring, const RingFeatureConfig& config) {
  const int count = static_cast<int>(ring.size());
  const int window = config.half_window;
  std::vector<bool> unreliable(ring.size());
  for (int i = window; i < count - window - 1; ++i) {
    const Eigen::Vector3f& point = ring[i].position;
    const Eigen::Vector3f& next = ring[i + 1].position;
    const float gap_after = squared_gap(ring, i + 1, i);
    if (gap_after > config.occlusion_gap_squared) {
      const bool hides_before = point.norm() > next.norm();
      if (hides_before && occludes(next, point, config.occlusion_ratio)) {
        for (int j = i - window; j <= i; ++j) unreliable[j] = true;
      } else if (!hides_before && occludes(point, next, config.occlusion_ratio)) {
        for (int j = i + 1; j <= i + window + 1; ++j) unreliable[j] = true;
      }
    }
    const double limit = config.parallel_ratio * point.squaredNorm();
    if (gap_after > limit && squared_gap(ring, i, i - 1) > limit) unreliable[i] = true;
  }
  return unreliable;
}

RingFeatures ring_features(const LidarScan& scan, const RingFeatureConfig& config) {
  RingFeatures features;
  for (const FeatureCloud& ring : ring_clouds(scan, config.min_range, config.max_range)) {
    features.points += static_cast<int>(ring.size());
    select_ring(ring, config, features);
  }
  return features;
}

}  // namespace aims::features
