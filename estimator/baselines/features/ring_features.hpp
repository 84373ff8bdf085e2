// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "core/config.hpp"
#include "core/measurements.hpp"
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

/// Edge and plane features by the curvature along each ring (Zhang and Singh, LOAM, RSS 2014,
/// section V-A, with the thresholds of the published code).
struct RingFeatureConfig {
  double min_range = 0.3;    ///< nearer returns are ignored [m]
  double max_range = 200.0;  ///< farther returns are ignored [m]
  SelectionConfig selection;
  double max_gap_squared = 0.05;       ///< neighbours up to a larger gap leave the choice [m^2]
  bool reject_unreliable = true;       ///< returns at an occlusion or on a nearly parallel surface
  double occlusion_gap_squared = 0.1;  ///< gap between two returns that may be an occlusion [m^2]
  double occlusion_ratio = 0.1;        ///< lateral gap over range below which it is one
  double parallel_ratio = 2e-4;        ///< squared gaps over squared range, on both sides, above
                                       ///< which the beam is nearly parallel to the surface
};

void describe(Fields& fields, RingFeatureConfig& config);

/// c_i = |sum over the neighbours of (p_j - p_i)|^2 of each point of a ring [m^2]; 0 where the ring
/// has fewer than `half_window` neighbours on one side.
std::vector<float> ring_curvature(const FeatureCloud& ring, int half_window);

/// Points of a ring beside an occlusion, on the far side, and points on a surface that the beam
/// nearly follows.
std::vector<bool> unreliable_points(const FeatureCloud& ring, const RingFeatureConfig& config);

RingFeatures ring_features(const LidarScan& scan, const RingFeatureConfig& config);

}  // namespace aims::features
