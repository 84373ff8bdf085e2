// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/baselines/lego_loam/segmented_features.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "estimator/baselines/lego_loam/azimuth_times.hpp"
#include "estimator/lidar/voxel_hash.hpp"

namespace aims::lego_loam {
namespace {

/// The kept returns of one ring, in order of columns.
struct SegmentedRing {
  features::FeatureCloud points;
  std::vector<float> ranges;
  std::vector<int> columns;
  std::vector<bool> ground;

  int size() const { return static_cast<int>(points.size()); }
  bool neighbors(int i, int reach) const { return columns[i + 1] - columns[i] <= reach; }
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

std::vector<float> range_curvature(const std::vector<float>& ranges, int window) {
  const int count = static_cast<int>(ranges.size());
  std::vector<float> curvature(ranges.size(), 0.0F);
  for (int i = window; i < count - window; ++i) {
    float sum = -2.0F * static_cast<float>(window) * ranges[i];
    for (int j = 1; j <= window; ++j) sum += ranges[i - j] + ranges[i + j];
    curvature[i] = sum * sum;
  }
  return curvature;
}

/// Returns on the far side of an occlusion, and on surfaces that the beam nearly follows.
std::vector<bool> unreliable_returns(const SegmentedRing& ring, const FeatureConfig& config) {
  const int window = config.selection.half_window;
  std::vector<bool> unreliable(ring.points.size());
  for (int i = window; i < ring.size() - window - 1; ++i) {
    const double step = ring.ranges[i + 1] - ring.ranges[i];
    if (ring.neighbors(i, config.occlusion_columns - 1)) {
      if (-step > config.occlusion_gap) {
        for (int j = i - window; j <= i; ++j) unreliable[j] = true;
      } else if (step > config.occlusion_gap) {
        for (int j = i + 1; j <= i + window + 1; ++j) unreliable[j] = true;
      }
    }
    const double limit = config.parallel_ratio * ring.ranges[i];
    const double before = std::abs(ring.ranges[i - 1] - ring.ranges[i]);
    if (before > limit && std::abs(step) > limit) unreliable[i] = true;
  }
  return unreliable;
}

features::RingCandidates candidates_of(SegmentedRing ring, const FeatureConfig& config) {
  features::RingCandidates candidates;
  candidates.curvature = range_curvature(ring.ranges, config.selection.half_window);
  candidates.unavailable = unreliable_returns(ring, config);
  candidates.joined.resize(ring.points.size());
  for (int i = 0; i + 1 < ring.size(); ++i) {
    candidates.joined[i] = ring.neighbors(i, config.occlusion_columns);
  }
  for (const bool ground : ring.ground) {
    candidates.may_be_edge.push_back(!ground);
    candidates.may_be_flat.push_back(ground);
  }
  candidates.points = std::move(ring.points);
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
  f.number("occlusion_gap", c.occlusion_gap,
           {"m", up_to(1e4), "range to the next return from which one hides the other"});
  f.integer("occlusion_columns", c.occlusion_columns,
            {"-", in_range(1, 100000), "cells up to which two returns are neighbours"});
  f.number("parallel_ratio", c.parallel_ratio,
           {"-", up_to(10.0), "changes of range over range; more is a parallel surface"});
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
    features::select_features(candidates_of(std::move(ring), config), config.selection,
                              result.features);
  }
  order_by_voxels(result.features.less_flat, config.selection.less_flat_voxel, config.voxel_order);
  return result;
}

}  // namespace aims::lego_loam
