// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/baselines/features/ring_reference.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

namespace aims::features {

void describe(Fields& f, RingMatchConfig& c) {
  f.number("max_distance", c.max_distance,
           {"m", positive_up_to(1e4), "of each matched feature of the last scan"});
  f.integer("ring_reach", c.ring_reach,
            {"-", in_range(1, kMaxRings), "rings up to which neighbouring rings are searched"});
}

void RingReference::set(FeatureCloud cloud) {
  cloud_ = std::move(cloud);
  index_.build(positions_of(cloud_));
  ring_begin_.assign(kMaxRings + 1, 0);
  for (const FeaturePoint& point : cloud_) ++ring_begin_[point.ring + 1];
  for (int ring = 0; ring < kMaxRings; ++ring) ring_begin_[ring + 1] += ring_begin_[ring];
}

std::optional<int> RingReference::nearest(const Eigen::Vector3f& point, double max_distance) const {
  std::array<Neighbor, 1> found;
  if (index_.nearest(point, found) == 0) return std::nullopt;
  if (found[0].squared_distance >= max_distance * max_distance) return std::nullopt;
  return found[0].index;
}

std::optional<int> RingReference::nearest_in_ring(const Eigen::Vector3f& point, int ring,
                                                  int excluded, double max_distance) const {
  std::optional<int> best;
  auto best_squared = static_cast<float>(max_distance * max_distance);
  for (int i = ring_begin_[ring]; i < ring_begin_[ring + 1]; ++i) {
    const float squared = (cloud_[i].position - point).squaredNorm();
    if (i == excluded || squared >= best_squared) continue;
    best = i;
    best_squared = squared;
  }
  return best;
}

std::optional<int> RingReference::nearest_in_other_rings(const Eigen::Vector3f& point, int ring,
                                                         const RingMatchConfig& config) const {
  std::optional<int> best;
  double limit = config.max_distance;
  const int first = std::max(0, ring - config.ring_reach);
  const int last = std::min(kMaxRings - 1, ring + config.ring_reach);
  for (int other = first; other <= last; ++other) {
    if (other == ring) continue;
    const std::optional<int> found = nearest_in_ring(point, other, -1, limit);
    if (!found) continue;
    best = found;
    limit = (cloud_[*found].position - point).norm();
  }
  return best;
}

std::optional<LineMatch> RingReference::line_near(const Eigen::Vector3f& point,
                                                  const RingMatchConfig& config) const {
  const std::optional<int> a = nearest(point, config.max_distance);
  if (!a) return std::nullopt;
  const std::optional<int> b = nearest_in_other_rings(point, cloud_[*a].ring, config);
  if (!b || position(*a) == position(*b)) return std::nullopt;
  LineMatch match;
  match.origin = position(*a);
  match.direction = (position(*a) - position(*b)).normalized();
  return match;
}

std::optional<PlaneMatch> RingReference::plane_near(const Eigen::Vector3f& point,
                                                    const RingMatchConfig& config) const {
  const std::optional<int> a = nearest(point, config.max_distance);
  if (!a) return std::nullopt;
  const int ring = cloud_[*a].ring;
  const std::optional<int> b = nearest_in_ring(point, ring, *a, config.max_distance);
  const std::optional<int> c = nearest_in_other_rings(point, ring, config);
  if (!b || !c) return std::nullopt;
  const Eigen::Vector3d normal = (position(*a) - position(*b)).cross(position(*a) - position(*c));
  if (normal.norm() <= std::numeric_limits<double>::epsilon()) return std::nullopt;
  PlaneMatch match;
  match.normal = normal.normalized();
  match.offset = -match.normal.dot(position(*a));
  return match;
}

}  // namespace aims::features
