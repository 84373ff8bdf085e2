// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/baselines/features/range_ring.hpp"

#include <cmath>

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

}  // namespace aims::features
