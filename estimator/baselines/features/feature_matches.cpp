// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/baselines/features/feature_matches.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>
#include <nanoflann.hpp>
#include <utility>

namespace aims::features {

namespace {

/// Most neighbours of one query.
constexpr std::size_t kMaxNeighbors = 16;

/// Points per leaf of the tree: fewer make it slower to build, more slower to search.
constexpr std::size_t kLeafSize = 15;

struct Points {
  std::vector<Eigen::Vector3f> values;

  std::size_t kdtree_get_point_count() const { return values.size(); }
  float kdtree_get_pt(std::size_t index, std::size_t axis) const {
    return values[index][static_cast<Eigen::Index>(axis)];
  }
  template <class Box>
  bool kdtree_get_bbox(Box&) const {
    return false;
  }
};

using KdTree =
    nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<float, Points>, Points, 3>;

}  // namespace

struct PointIndex::Tree {
  Points points;
  std::unique_ptr<KdTree> index;
};

PointIndex::PointIndex() : tree_(std::make_unique<Tree>()) {}
PointIndex::~PointIndex() = default;

void PointIndex::build(std::vector<Eigen::Vector3f> points) {
  tree_->points.values = std::move(points);
  tree_->index.reset();
  if (tree_->points.values.empty()) return;
  tree_->index = std::make_unique<KdTree>(3, tree_->points,
                                          nanoflann::KDTreeSingleIndexAdaptorParams(kLeafSize));
}

std::size_t PointIndex::nearest(const Eigen::Vector3f& query, std::span<Neighbor> neighbors) const {
  assert(neighbors.size() <= kMaxNeighbors);
  if (!tree_->index) return 0;
  std::array<std::size_t, kMaxNeighbors> indices;
  std::array<float, kMaxNeighbors> distances;
  nanoflann::KNNResultSet<float> found(neighbors.size());
  found.init(indices.data(), distances.data());
  tree_->index->findNeighbors(found, query.data(), nanoflann::SearchParams());
  for (std::size_t i = 0; i < found.size(); ++i) {
    neighbors[i] = {static_cast<int>(indices[i]), distances[i]};
  }
  return found.size();
}

const std::vector<Eigen::Vector3f>& PointIndex::points() const { return tree_->points.values; }

std::vector<Eigen::Vector3f> positions_of(const FeatureCloud& cloud) {
  std::vector<Eigen::Vector3f> positions;
  positions.reserve(cloud.size());
  for (const FeaturePoint& point : cloud) positions.push_back(point.position);
  return positions;
}

Pose moved(const Pose& pose, const Vector6& step) {
  return {(so3_exp(step.head<3>()) * pose.rotation).normalized(),
          pose.translation + step.tail<3>()};
}

DistanceRow distance_row(const LineMatch& match, const Pose& pose) {
  const Pose part = part_of(pose, match.fraction);
  DistanceRow row;
  row.arm = part.rotation * match.point;
  const Eigen::Vector3d point = row.arm + part.translation;
  const Eigen::Vector3d from_origin = point - match.origin;
  const Eigen::Vector3d across = from_origin - match.direction * match.direction.dot(from_origin);
  row.distance = across.norm();
  if (row.distance > 0.0) row.gradient = across / row.distance;
  row.range = point.norm();
  return row;
}

DistanceRow distance_row(const PlaneMatch& match, const Pose& pose) {
  const Pose part = part_of(pose, match.fraction);
  DistanceRow row;
  row.arm = part.rotation * match.point;
  const Eigen::Vector3d point = row.arm + part.translation;
  row.distance = match.normal.dot(point) + match.offset;
  row.gradient = match.normal;
  row.range = point.norm();
  return row;
}

void weighted_distances(const FeatureMatches& matches, const Pose& pose,
                        const DistanceWeight& weighting, const TakeDistance& take) {
  const auto offer = [&](const Eigen::Vector3d& point, const DistanceRow& row, double scale) {
    const double weight = 1.0 - weighting.slope * std::abs(row.distance) / scale;
    if (weight > weighting.least && row.distance != 0.0) take(point, row, weight);
  };
  for (const LineMatch& match : matches.lines) {
    offer(match.point, distance_row(match, pose), 1.0);
  }
  for (const PlaneMatch& match : matches.planes) {
    const DistanceRow row = distance_row(match, pose);
    offer(match.point, row, std::sqrt(row.range));
  }
}

namespace {

/// Longer motions between two scans are no solutions [m].
constexpr double kMaxMotion = 100.0;

double fraction_of(const FeaturePoint& point, bool deskew) {
  return deskew ? static_cast<double>(point.fraction) : 1.0;
}

/// In the axes at the end of the last scan.
Eigen::Vector3f at_start(const FeaturePoint& point, const Pose& motion, bool deskew) {
  const Pose part = part_of(motion, fraction_of(point, deskew));
  return (part * point.position.cast<double>()).cast<float>();
}

}  // namespace

void describe(Fields& f, RingMatchConfig& c) {
  f.number("max_distance", c.max_distance,
           {"m", positive_up_to(1e4), "of each matched feature of the last scan"});
  f.integer("ring_reach", c.ring_reach,
            {"-", in_range(1, kMaxRings), "rings up to which neighbouring rings are searched"});
  f.flag("truncated_search", c.truncated_search,
         {"", any(), "search after the nearest feature as little as the public programs do"});
}

void RingReference::set(FeatureCloud cloud) {
  cloud_ = std::move(cloud);
  index_.build(positions_of(cloud_));
  ring_begin_.assign(kMaxRings + 1, 0);
  for (const FeaturePoint& point : cloud_) ++ring_begin_[point.ring + 1];
  for (int ring = 0; ring < kMaxRings; ++ring) ring_begin_[ring + 1] += ring_begin_[ring];
}

std::optional<RingReference::Search> RingReference::start_search(
    const Eigen::Vector3f& point, std::size_t count, const RingMatchConfig& config) const {
  std::array<Neighbor, 1> found;
  if (index_.nearest(point, found) == 0) return std::nullopt;
  const double max_squared_distance = config.max_distance * config.max_distance;
  if (found[0].squared_distance >= max_squared_distance) return std::nullopt;
  const int size = static_cast<int>(cloud_.size());
  const int end = std::max(found[0].index + 1, std::min(size, static_cast<int>(count)));
  return Search{point, found[0].index, config.truncated_search ? end : size};
}

/// Without the nearest feature of all.
std::optional<int> RingReference::nearest_in_ring(const Search& search, int ring,
                                                  double max_distance) const {
  std::optional<int> best;
  auto best_squared = static_cast<float>(max_distance * max_distance);
  const int end = std::min(ring_begin_[ring + 1], search.end);
  for (int i = ring_begin_[ring]; i < end; ++i) {
    const float squared = (cloud_[i].position - search.point).squaredNorm();
    if (i == search.nearest || squared >= best_squared) continue;
    best = i;
    best_squared = squared;
  }
  return best;
}

std::optional<int> RingReference::nearest_in_other_rings(const Search& search,
                                                         const RingMatchConfig& config) const {
  std::optional<int> best;
  double limit = config.max_distance;
  const int ring = cloud_[search.nearest].ring;
  const int first = std::max(0, ring - config.ring_reach);
  const int last = std::min(kMaxRings - 1, ring + config.ring_reach);
  for (int other = first; other <= last; ++other) {
    if (other == ring) continue;
    const std::optional<int> found = nearest_in_ring(search, other, limit);
    if (!found) continue;
    best = found;
    limit = (cloud_[*found].position - search.point).norm();
  }
  return best;
}

std::optional<LineMatch> RingReference::line_near(const Eigen::Vector3f& point, std::size_t count,
                                                  const RingMatchConfig& config) const {
  const std::optional<Search> search = start_search(point, count, config);
  if (!search) return std::nullopt;
  const std::optional<int> other = nearest_in_other_rings(*search, config);
  if (!other) return std::nullopt;
  const Eigen::Vector3d along = position(search->nearest) - position(*other);
  if (along.isZero()) return std::nullopt;
  LineMatch match;
  match.origin = position(search->nearest);
  match.direction = along.normalized();
  return match;
}

std::optional<PlaneMatch> RingReference::plane_near(const Eigen::Vector3f& point, std::size_t count,
                                                    const RingMatchConfig& config) const {
  const std::optional<Search> search = start_search(point, count, config);
  if (!search) return std::nullopt;
  const int ring = cloud_[search->nearest].ring;
  const std::optional<int> b = nearest_in_ring(*search, ring, config.max_distance);
  const std::optional<int> c = nearest_in_other_rings(*search, config);
  if (!b || !c) return std::nullopt;
  const Eigen::Vector3d a = position(search->nearest);
  const Eigen::Vector3d normal = (a - position(*b)).cross(a - position(*c));
  if (normal.norm() <= std::numeric_limits<double>::epsilon()) return std::nullopt;
  PlaneMatch match;
  match.normal = normal.normalized();
  match.offset = -match.normal.dot(a);
  return match;
}

std::vector<LineMatch> line_matches(const FeatureCloud& edges, const Pose& motion, bool deskew,
                                    const RingReference& reference, const RingMatchConfig& config) {
  std::vector<LineMatch> matches;
  for (const FeaturePoint& edge : edges) {
    auto line = reference.line_near(at_start(edge, motion, deskew), edges.size(), config);
    if (!line) continue;
    line->point = edge.position.cast<double>();
    line->fraction = fraction_of(edge, deskew);
    matches.push_back(*line);
  }
  return matches;
}

std::vector<PlaneMatch> plane_matches(const FeatureCloud& flat, const Pose& motion, bool deskew,
                                      const RingReference& reference,
                                      const RingMatchConfig& config) {
  std::vector<PlaneMatch> matches;
  for (const FeaturePoint& point : flat) {
    auto plane = reference.plane_near(at_start(point, motion, deskew), flat.size(), config);
    if (!plane) continue;
    plane->point = point.position.cast<double>();
    plane->fraction = fraction_of(point, deskew);
    matches.push_back(*plane);
  }
  return matches;
}

void move_to_scan_end(FeatureCloud& cloud, const Pose& motion) {
  const Pose T_end_start = motion.inverse();
  for (FeaturePoint& point : cloud) {
    const Eigen::Vector3d start = part_of(motion, point.fraction) * point.position.cast<double>();
    point.position = (T_end_start * start).cast<float>();
    point.fraction = 1.0F;
  }
}

bool plausible_motion(const Pose& motion) {
  return motion.rotation.coeffs().allFinite() && motion.translation.norm() < kMaxMotion;
}

}  // namespace aims::features
