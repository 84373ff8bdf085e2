// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "estimator/baselines/features/feature_selection.hpp"
#include "estimator/baselines/features/ring_features.hpp"
#include "estimator/baselines/lego_loam/range_image.hpp"

namespace aims::lego_loam {

/// Where the firing times of returns come from.
enum class PointTimes {
  kMeasured,  ///< the LiDAR's own
  kAzimuth,   ///< from azimuths, as the published program has them: `AzimuthTimes`
};

/// In which order the voxels of less flat features follow each other, the slowest axis first.
enum class VoxelOrder {
  kForwardUpLeft,  ///< the published LeGO-LOAM, which works in axes of a camera
  kUpLeftForward,  ///< the published LINS
};

/// Edges and planes of the segmented scan (LeGO-LOAM, section III-C).
struct FeatureConfig {
  PointTimes point_times = PointTimes::kAzimuth;
  features::SelectionConfig selection;
  /// The search for neighbours depends on the order where `truncated_search` is on.
  VoxelOrder voxel_order = VoxelOrder::kForwardUpLeft;
  features::RangeRingConfig reliability = {};
};

void describe(Fields& fields, FeatureConfig& config);

struct SegmentedFeatures {
  features::RingFeatures features;
  features::FeatureCloud outliers;  ///< of small segments above the ground rows
  int ground = 0;                   ///< returns of the ground
  int segmented = 0;                ///< returns of kept segments
};

/// Edges are returns of segments, flat points returns of the ground; the curvature of return i is
/// c_i = (sum over ring neighbours of (r_j - r_i))^2 with ranges r [m^2].
SegmentedFeatures segmented_features(const RangeImage& image, const RangeImageConfig& image_config,
                                     const FeatureConfig& config);

}  // namespace aims::lego_loam
