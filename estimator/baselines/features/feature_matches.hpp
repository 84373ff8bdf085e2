// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "core/config.hpp"
#include "core/lie.hpp"
#include "estimator/baselines/features/feature_selection.hpp"
#include "estimator/filter/error_state.hpp"

namespace aims::features {

/// A map point and its squared distance from the query [m^2].
struct Neighbor {
  int index = 0;
  float squared_distance = 0.0F;
};

/// A k-d tree over points, for nearest neighbours.
class PointIndex {
 public:
  PointIndex();
  ~PointIndex();
  PointIndex(const PointIndex&) = delete;
  PointIndex& operator=(const PointIndex&) = delete;

  /// Builds the tree of the points, replacing any other.
  void build(std::vector<Eigen::Vector3f> points);

  /// The nearest points in order of distance, as many as `neighbors` holds or as there are;
  /// returns how many.
  std::size_t nearest(const Eigen::Vector3f& query, std::span<Neighbor> neighbors) const;

  const std::vector<Eigen::Vector3f>& points() const;

 private:
  struct Tree;
  std::unique_ptr<Tree> tree_;
};

/// The positions of a cloud [m].
std::vector<Eigen::Vector3f> positions_of(const FeatureCloud& cloud);

/// A point of the scan and the line that it is to lie on. The line is in target axes.
struct LineMatch {
  Eigen::Vector3d point = Eigen::Vector3d::Zero();       ///< scan axes [m]
  double fraction = 1.0;                                 ///< of the pose, at which it was measured
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();      ///< of the line [m]
  Eigen::Vector3d direction = Eigen::Vector3d::UnitX();  ///< of the line, unit
};

/// A point of the scan and the plane that it is to lie on, n . x + d = 0 in target axes.
struct PlaneMatch {
  Eigen::Vector3d point = Eigen::Vector3d::Zero();    ///< scan axes [m]
  double fraction = 1.0;                              ///< of the pose, at which it was measured
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  ///< n, unit
  double offset = 0.0;                                ///< d [m]
};

struct FeatureMatches {
  std::vector<LineMatch> lines;
  std::vector<PlaneMatch> planes;

  int size() const { return static_cast<int>(lines.size() + planes.size()); }
};

/// Distance of a matched point from its line or plane.
struct DistanceRow {
  double distance = 0.0;                               ///< [m], of a plane with sign
  Eigen::Vector3d gradient = Eigen::Vector3d::Zero();  ///< of the distance in the point, unit
  Eigen::Vector3d arm = Eigen::Vector3d::Zero();       ///< R p, from the sensor to the point [m]
  double range = 0.0;                                  ///< of the point in target axes [m]

  /// Derivative in the rotation and position of the pose: R Exp-left-perturbed, t added.
  Vector6 jacobian() const {
    Vector6 row;
    row << arm.cross(gradient), gradient;
    return row;
  }
};

/// The part `fraction` of the motion `pose` from the identity.
inline Pose part_of(const Pose& pose, double fraction) {
  return fraction == 1.0 ? pose : interpolate(Pose(), pose, fraction);
}

/// The pose after a step: rotation vector about target axes [rad], then translation [m].
Pose moved(const Pose& pose, const Vector6& step);

/// The distance at the pose T_target_scan.
DistanceRow distance_row(const LineMatch& match, const Pose& pose);
DistanceRow distance_row(const PlaneMatch& match, const Pose& pose);

/// How the weight of a distance falls with the distance (LOAM, section V-C).
struct DistanceWeight {
  double slope = 0.0;  ///< weight = 1 - slope |d|, of a plane |d| / sqrt(range) [1/m]
  double least = 0.0;  ///< distances of no more weight are left out
};

/// Takes the point in scan axes, its distance and the weight of it.
using TakeDistance =
    std::function<void(const Eigen::Vector3d& point, const DistanceRow& row, double weight)>;

/// Hands over the distances at the pose T_target_scan that are not zero and weigh enough.
void weighted_distances(const FeatureMatches& matches, const Pose& pose,
                        const DistanceWeight& weighting, const TakeDistance& take);

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
