// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "core/config.hpp"
#include "estimator/baselines/features/feature_selection.hpp"

namespace aims::features {

/// Returns of one ring of a range image, in order of columns; one entry per return.
struct RangeRing {
  FeatureCloud points;
  std::vector<float> ranges;  ///< [m]
  std::vector<int> columns;   ///< of the image

  int size() const { return static_cast<int>(points.size()); }
  bool neighbors(int i, int reach) const { return columns[i + 1] - columns[i] <= reach; }
};

/// Which returns of a range image are reliable (LeGO-LOAM and LIO-SAM, published programs).
struct RangeRingConfig {
  double occlusion_gap = 0.3;    ///< range to the next return from which one hides the other [m]
  int occlusion_columns = 10;    ///< cells up to which two returns are neighbours
  double parallel_ratio = 0.02;  ///< changes of range on both sides, over the range, above which
                                 ///< the beam is nearly parallel to the surface
};

void describe(Fields& fields, RangeRingConfig& config);

/// c_i = (sum over the neighbours of (r_j - r_i))^2 of the ranges along a ring [m^2]; 0 where the
/// ring has fewer than `half_window` neighbours on one side.
std::vector<float> range_curvature(const std::vector<float>& ranges, int half_window);

/// Returns on the far side of an occlusion, and on surfaces that the beam nearly follows.
std::vector<bool> unreliable_returns(const RangeRing& ring, const RangeRingConfig& config,
                                     int half_window);

/// A ring with all that decides on its returns except `may_be_edge` and `may_be_flat`.
RingCandidates range_candidates(const RangeRing& ring, const RangeRingConfig& config,
                                int half_window);

}  // namespace aims::features
