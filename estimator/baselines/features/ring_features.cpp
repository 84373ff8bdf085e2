// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/baselines/features/ring_features.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace aims::features {

void describe(Fields& f, RangeRingConfig& c) {
  f.number("occlusion_gap", c.occlusion_gap,
           {"m", up_to(1e4), "range to the next return from which one hides the other"});
  f.integer("occlusion_columns", c.occlusion_columns,
            {"-", in_range(1, 100000), "cells up to which two returns are neighbours"});
  f.number("parallel_ratio", c.parallel_ratio,
           {"-", up_to(10.0), "changes of range over range; more is a parallel surface"});
}

std::vector<float> range_curvature(const std::vector<float>& ranges, int half_window) {
  const int count = static_cast<int>(ranges.size());
  std::vector<float> curvature(ranges.size(), 0.0F);
  for (int i = half_window; i < count - half_window; ++i) {
    float sum = -2.0F * static_cast<float>(half_window) * ranges[i];
    for (int j = 1; j <= half_window; ++j) sum += ranges[i - j] + ranges[i + j];
    curvature[i] = sum * sum;
  }
  return curvature;
}

std::vector<bool> unreliable_returns(const RangeRing& ring, const RangeRingConfig& config,
                                     int half_window) {
  std::vector<bool> unreliable(ring.points.size());
  for (int i = half_window; i < ring.size() - half_window - 1; ++i) {
    const double step = ring.ranges[i + 1] - ring.ranges[i];
    if (ring.neighbors(i, config.occlusion_columns - 1)) {
      if (-step > config.occlusion_gap) {
        for (int j = i - half_window; j <= i; ++j) unreliable[j] = true;
      } else if (step > config.occlusion_gap) {
        for (int j = i + 1; j <= i + half_window + 1; ++j) unreliable[j] = true;
      }
    }
    const double limit = config.parallel_ratio * ring.ranges[i];
    const double before = std::abs(ring.ranges[i - 1] - ring.ranges[i]);
    if (before > limit && std::abs(step) > limit) unreliable[i] = true;
  }
  return unreliable;
}

RingCandidates range_candidates(const RangeRing& ring, const RangeRingConfig& config,
                                int half_window) {
  RingCandidates candidates;
  candidates.points = ring.points;
  candidates.curvature = range_curvature(ring.ranges, half_window);
  candidates.unavailable = unreliable_returns(ring, config, half_window);
  candidates.joined.resize(ring.points.size());
  for (int i = 0; i + 1 < ring.size(); ++i) {
    candidates.joined[i] = ring.neighbors(i, config.occlusion_columns);
  }
  return candidates;
}

namespace {

float squared_gap(const FeatureCloud& ring, int a, int b) {
  return (ring[a].position - ring[b].position).squaredNorm();
}

/// Whether the nearer of two returns hides part of the surface of the farther: on the circle of the
/// nearer one their beams are close.
bool occludes(const Eigen::Vector3f& near, const Eigen::Vector3f& far, double ratio) {
  const float range = near.norm();
  return (near - far * (range / far.norm())).norm() / range < ratio;
}

RingCandidates candidates_of(FeatureCloud ring, const RingFeatureConfig& config) {
  RingCandidates candidates;
  const std::size_t count = ring.size();
  candidates.curvature = ring_curvature(ring, config.selection.half_window);
  candidates.unavailable =
      config.reject_unreliable ? unreliable_points(ring, config) : std::vector<bool>(count);
  candidates.joined.resize(count);
  for (int i = 0; i + 1 < static_cast<int>(count); ++i) {
    candidates.joined[i] = squared_gap(ring, i + 1, i) <= config.max_gap_squared;
  }
  candidates.may_be_edge.assign(count, true);
  candidates.may_be_flat.assign(count, true);
  candidates.points = std::move(ring);
  return candidates;
}

}  // namespace

void describe(Fields& f, RingFeatureConfig& c) {
  f.number("min_range", c.min_range, {"m", up_to(1e4), "nearer returns are ignored"});
  f.number("max_range", c.max_range, {"m", positive_up_to(1e4), "farther returns are ignored"});
  f.group("selection", c.selection);
  f.number("max_gap_squared", c.max_gap_squared,
           {"m^2", up_to(1e6), "neighbours of a feature up to a larger gap are not chosen"});
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
  const int window = config.selection.half_window;
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
  for (FeatureCloud& ring : ring_clouds(scan, config.min_range, config.max_range)) {
    features.points += static_cast<int>(ring.size());
    select_features(candidates_of(std::move(ring), config), config.selection, features);
  }
  return features;
}

}  // namespace aims::features
