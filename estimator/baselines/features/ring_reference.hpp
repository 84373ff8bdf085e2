// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "core/config.hpp"
#include "estimator/baselines/features/feature_matches.hpp"
#include "estimator/baselines/features/feature_point.hpp"
#include "estimator/baselines/features/point_index.hpp"

namespace aims::features {

/// Which features of the last scan a feature is matched with (LOAM, section V-B).
struct RingMatchConfig {
  double max_distance = 5.0;  ///< of each matched feature [m]
  int ring_reach = 2;         ///< rings up to which neighbouring rings are searched
};

void describe(Fields& fields, RingMatchConfig& config);

/// Features of the last scan, among which those of the present one find their lines and planes.
class RingReference {
 public:
  /// Replaces the features; `cloud` is in order of rings.
  void set(FeatureCloud cloud);

  std::size_t size() const { return cloud_.size(); }

  /// The line through the nearest feature and the nearest of another ring in reach. `point` is in
  /// the axes of the last scan.
  std::optional<LineMatch> line_near(const Eigen::Vector3f& point,
                                     const RingMatchConfig& config) const;

  /// The plane through the nearest feature, the nearest other of the same ring and the nearest of
  /// another ring in reach.
  std::optional<PlaneMatch> plane_near(const Eigen::Vector3f& point,
                                       const RingMatchConfig& config) const;

 private:
  std::optional<int> nearest(const Eigen::Vector3f& point, double max_distance) const;
  std::optional<int> nearest_in_ring(const Eigen::Vector3f& point, int ring, int excluded,
                                     double max_distance) const;
  std::optional<int> nearest_in_other_rings(const Eigen::Vector3f& point, int ring,
                                            const RingMatchConfig& config) const;
  Eigen::Vector3d position(int index) const { return cloud_[index].position.cast<double>(); }

  FeatureCloud cloud_;
  std::vector<int> ring_begin_;  ///< index of the first feature of each ring, and the end
  PointIndex index_;
};

}  // namespace aims::features
