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
  /// Among features after the nearest one, those are searched whose index is below the number of
  /// features to be matched: in most cases none. So do the public LOAM and LeGO-LOAM.
  bool truncated_search = false;
};

void describe(Fields& fields, RingMatchConfig& config);

/// Features of the last scan, among which those of the present one find their lines and planes.
class RingReference {
 public:
  /// Replaces the features; `cloud` is in order of rings.
  void set(FeatureCloud cloud);

  std::size_t size() const { return cloud_.size(); }

  /// The line through the nearest feature and the nearest of another ring in reach. `point` is in
  /// the axes of the last scan; it is one of `count` points to be matched.
  std::optional<LineMatch> line_near(const Eigen::Vector3f& point, std::size_t count,
                                     const RingMatchConfig& config) const;

  /// The plane through the nearest feature, the nearest other of the same ring and the nearest of
  /// another ring in reach.
  std::optional<PlaneMatch> plane_near(const Eigen::Vector3f& point, std::size_t count,
                                       const RingMatchConfig& config) const;

 private:
  /// A search around the feature `nearest`, among the features before `end`.
  struct Search {
    Eigen::Vector3f point;
    int nearest = 0;
    int end = 0;
  };
  std::optional<Search> start_search(const Eigen::Vector3f& point, std::size_t count,
                                     const RingMatchConfig& config) const;
  std::optional<int> nearest_in_ring(const Search& search, int ring, double max_distance) const;
  std::optional<int> nearest_in_other_rings(const Search& search,
                                            const RingMatchConfig& config) const;
  Eigen::Vector3d position(int index) const { return cloud_[index].position.cast<double>(); }

  FeatureCloud cloud_;
  std::vector<int> ring_begin_;  ///< index of the first feature of each ring, and the end
  PointIndex index_;
};

/// Lines for edges of the present scan; `motion` is T_last_present, from the end of the last scan
/// to that of the present one. With `deskew`, each point is at the part of the motion at its own
/// time.
std::vector<LineMatch> line_matches(const FeatureCloud& edges, const Pose& motion, bool deskew,
                                    const RingReference& reference, const RingMatchConfig& config);

/// Likewise planes for flat points.
std::vector<PlaneMatch> plane_matches(const FeatureCloud& flat, const Pose& motion, bool deskew,
                                      const RingReference& reference,
                                      const RingMatchConfig& config);

/// Moves points measured during a scan with the motion T_start_end to where they would have been
/// measured at its end.
void move_to_scan_end(FeatureCloud& cloud, const Pose& motion);

/// Whether a motion from scan to scan is finite and not longer than any sensor moves.
bool plausible_motion(const Pose& motion);

}  // namespace aims::features
