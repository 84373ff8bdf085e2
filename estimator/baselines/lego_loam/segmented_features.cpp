// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/baselines/lego_loam/segmented_features.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "estimator/baselines/lego_loam/range_image.hpp"
#include "estimator/lidar/voxel_hash.hpp"

namespace aims::lego_loam {
namespace {

/// The kept returns of one ring, in order of columns.
struct SegmentedRing : features::RangeRing {
  std::vector<bool> ground;
};

bool keeps_column(int column, int columns, int window, int stride) {
  return column % stride == 0 || column <= window || column >= columns - window;
}

SegmentedRing segmented_ring(const RangeImage& image, int row, int window, int stride) {
  SegmentedRing ring;
  for (int column = 0; column < image.columns(); ++column) {
    const CellKind kind = image.kind(row, column);
    const bool ground = kind == CellKind::kGround;
    if (kind != CellKind::kSegment && !ground) continue;
    if (ground && !keeps_column(column, image.columns(), window, stride)) continue;
    ring.points.push_back(image.point(row, column));
    ring.ranges.push_back(image.range(row, column));
    ring.columns.push_back(column);
    ring.ground.push_back(ground);
  }
  return ring;
}

void set_times(features::FeatureCloud& points, AzimuthTimes& times) {
  for (features::FeaturePoint& point : points) {
    point.fraction = static_cast<float>(times.next(azimuth_of(point.position)));
  }
}

features::RingCandidates candidates_of(const SegmentedRing& ring, const FeatureConfig& config) {
  features::RingCandidates candidates =
      features::range_candidates(ring, config.reliability, config.selection.half_window);
  for (const bool ground : ring.ground) {
    candidates.may_be_edge.push_back(!ground);
    candidates.may_be_flat.push_back(ground);
  }
  return candidates;
}

/// Orders the features of each ring by their voxels, as the published programs have them: their
/// search for neighbours depends on the order.
void order_by_voxels(features::FeatureCloud& cloud, double voxel, VoxelOrder order) {
  const auto inverse_size = static_cast<float>(1.0 / voxel);
  const auto key = [&](const features::FeaturePoint& point) {
    const VoxelIndex index = voxel_of(point.position, inverse_size);
    return order == VoxelOrder::kForwardUpLeft ? std::array{point.ring, index.x, index.z, index.y}
                                               : std::array{point.ring, index.z, index.y, index.x};
  };
  std::stable_sort(cloud.begin(), cloud.end(),
                   [&](const auto& a, const auto& b) { return key(a) < key(b); });
}

}  // namespace

void describe(Fields& f, FeatureConfig& c) {
  f.choice("point_times", c.point_times,
           {{"measured", PointTimes::kMeasured}, {"azimuth", PointTimes::kAzimuth}},
           {"", any(), "firing times of the returns: measured, or from azimuths as published"});
  f.group("selection", c.selection);
  f.choice("voxel_order", c.voxel_order,
           {{"forward_up_left", VoxelOrder::kForwardUpLeft},
            {"up_left_forward", VoxelOrder::kUpLeftForward}},
           {"", any(), "order of the voxels of less flat features, slowest axis first"});
  describe(f, c.reliability);
}

SegmentedFeatures segmented_features(const RangeImage& image, const RangeImageConfig& image_config,
                                     const FeatureConfig& config) {
  SegmentedFeatures result;
  result.features.points = image.count();
  AzimuthTimes times(image.first_azimuth(), image.last_azimuth());
  for (int row = 0; row < image.rows(); ++row) {
    for (int column = 0; column < image.columns(); ++column) {
      const CellKind kind = image.kind(row, column);
      result.ground += kind == CellKind::kGround;
      result.segmented += kind == CellKind::kSegment;
      const bool above_ground = row > image_config.ground_rows;
      if (kind == CellKind::kOutlier && above_ground && column % image_config.stride == 0) {
        result.outliers.push_back(image.point(row, column));
      }
    }
    SegmentedRing ring =
        segmented_ring(image, row, config.selection.half_window, image_config.stride);
    if (config.point_times == PointTimes::kAzimuth) set_times(ring.points, times);
    features::select_features(candidates_of(ring, config), config.selection, result.features);
  }
  order_by_voxels(result.features.less_flat, config.selection.less_flat_voxel, config.voxel_order);
  return result;
}

}  // namespace aims::lego_loam
