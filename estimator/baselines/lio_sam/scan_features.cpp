// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/baselines/lio_sam/scan_features.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <numbers>
#include <optional>
#include <utility>

#include "estimator/baselines/lio_sam/mapping.hpp"

namespace aims::lio_sam {

GyroRotation::GyroRotation(const std::vector<ImuSample>& samples, Time end) {
  for (const ImuSample& sample : samples) {
    if (sample.stamp > end + kSampleMargin) break;
    if (stamps_.empty()) {
      angles_.emplace_back(Eigen::Vector3d::Zero());
    } else {
      const double step = to_seconds(sample.stamp - stamps_.back());
      angles_.emplace_back(angles_.back() + sample.angular_velocity * step);
    }
    stamps_.push_back(sample.stamp);
  }
}

Eigen::Vector3d GyroRotation::angles_at(Time stamp) const {
  const auto after = std::upper_bound(stamps_.begin(), stamps_.end(), stamp);
  if (after == stamps_.begin()) return angles_.front();
  if (after == stamps_.end()) return angles_.back();
  const auto i = static_cast<std::size_t>(after - stamps_.begin());
  const double fraction =
      to_seconds(stamp - stamps_[i - 1]) / to_seconds(stamps_[i] - stamps_[i - 1]);
  return (1.0 - fraction) * angles_[i - 1] + fraction * angles_[i];
}

Eigen::Matrix3f GyroRotation::rotation_at(Time stamp) const {
  const Eigen::Vector3d angles = angles_at(stamp);
  return rotation_of({angles.x(), angles.y(), angles.z()}).toRotationMatrix().cast<float>();
}

namespace {

/// More flat points than a sector has: their number has no bound.
constexpr int kAnyNumber = 1000000;

int column_of(const Eigen::Vector3f& position, int columns) {
  const double azimuth =
      std::atan2(static_cast<double>(position.y()), static_cast<double>(position.x()));
  const long column = std::lround(azimuth / (2.0 * std::numbers::pi) * columns) + columns / 2;
  return static_cast<int>((column % columns + columns) % columns);
}

features::SelectionConfig selection_of(const FeatureConfig& config) {
  return {.half_window = config.half_window,
          .sectors = config.sectors,
          .max_sharp = 0,
          .max_less_sharp = config.max_edges,
          .max_flat = kAnyNumber,
          .curvature = config.edge_curvature,
          .less_flat_voxel = config.surface_voxel};
}

/// Turns returns to the axes of the first one.
class Deskewing {
 public:
  Deskewing(const LidarScan& scan, const GyroRotation& rotation)
      : begin_(scan.stamp), rotation_(rotation) {}

  Eigen::Vector3f operator()(const LidarPoint& point) {
    if (!rotation_.available()) return point.position;
    if (first_ || point.time_offset_ns != offset_) {  // the rings of a column fire together
      offset_ = point.time_offset_ns;
      R_ = rotation_.rotation_at(begin_ + offset_);
    }
    if (std::exchange(first_, false)) R_first_inverse_ = R_.transpose();
    return R_first_inverse_ * (R_ * point.position);
  }

 private:
  Time begin_;
  const GyroRotation& rotation_;
  bool first_ = true;
  std::int32_t offset_ = 0;
  Eigen::Matrix3f R_ = Eigen::Matrix3f::Identity();  ///< at `offset_`
  Eigen::Matrix3f R_first_inverse_ = Eigen::Matrix3f::Identity();
};

using RingCells = std::map<int, std::vector<std::optional<features::FeaturePoint>>>;

features::RangeRing ring_of(const std::vector<std::optional<features::FeaturePoint>>& cells) {
  features::RangeRing ring;
  for (std::size_t column = 0; column < cells.size(); ++column) {
    if (!cells[column]) continue;
    ring.points.push_back(*cells[column]);
    ring.ranges.push_back(cells[column]->position.norm());
    ring.columns.push_back(static_cast<int>(column));
  }
  return ring;
}

}  // namespace

void describe(Fields& f, ImageConfig& c) {
  f.number("min_range", c.min_range, {"m", up_to(1e4), "nearer returns are ignored"});
  f.number("max_range", c.max_range, {"m", in_range(0.1, 1e4), "farther returns are ignored"});
  f.integer("columns", c.columns,
            {"-", in_range(10, 100000), "cells of one turn; each keeps its first return"});
}

void describe(Fields& f, FeatureConfig& c) {
  f.integer("half_window", c.half_window,
            {"-", in_range(1, 50), "ring neighbours on each side in the curvature"});
  f.integer("sectors", c.sectors, {"-", in_range(1, 100), "parts of a ring with equal returns"});
  f.integer("max_edges", c.max_edges, {"-", in_range(0, 1000), "edges per sector at most"});
  f.number("edge_curvature", c.edge_curvature,
           {"m^2", positive_up_to(1e6), "edges have more curvature", "edgeThreshold"});
  f.number(
      "flat_curvature", c.flat_curvature,
      {"m^2", positive_up_to(1e6),
       "flat points have less; edges beyond the end of a sector keep off them", "surfThreshold"});
  f.number("surface_voxel", c.surface_voxel,
           {"m", in_range(0.01, 10.0), "surfaces are averaged in such voxels, per ring",
            "odometrySurfLeafSize"});
  describe(f, c.reliability);
}

std::vector<features::RangeRing> deskewed_rings(const LidarScan& scan, const GyroRotation& rotation,
                                                const ImageConfig& config) {
  Deskewing deskew(scan, rotation);
  const double duration = std::max(1.0, static_cast<double>(scan.end - scan.stamp));
  RingCells rings;
  for (const LidarPoint& point : scan.points) {
    const double range = point.position.cast<double>().norm();
    const bool in_range = range >= config.min_range && range <= config.max_range;
    if (!in_range || point.ring >= features::kMaxRings) continue;
    auto& cells = rings[point.ring];
    cells.resize(static_cast<std::size_t>(config.columns));
    auto& cell = cells[static_cast<std::size_t>(column_of(point.position, config.columns))];
    if (cell) continue;
    cell = features::FeaturePoint{deskew(point),
                                  static_cast<float>(point.time_offset_ns / duration), point.ring};
  }
  std::vector<features::RangeRing> result;
  for (const auto& [index, cells] : rings) result.push_back(ring_of(cells));
  return result;
}

ScanFeatures scan_features(const std::vector<features::RangeRing>& rings,
                           const FeatureConfig& config) {
  features::RingFeatures selected;
  ScanFeatures result;
  for (const features::RangeRing& ring : rings) {
    result.points += ring.size();
    features::RingCandidates candidates =
        features::range_candidates(ring, config.reliability, config.half_window);
    candidates.may_be_edge.assign(ring.points.size(), true);
    for (const float curvature : candidates.curvature) {
      candidates.may_be_flat.push_back(curvature < config.flat_curvature);
    }
    features::select_features(candidates, selection_of(config), selected);
  }
  result.edges = std::move(selected.less_sharp);
  result.surface = std::move(selected.less_flat);
  return result;
}

}  // namespace aims::lio_sam
