// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/lidar/deskew.hpp"

#include <algorithm>

namespace aims {
namespace {

/// Spacing of the knots; points are interpolated linearly between them.
constexpr Duration kStep = kMillisecond;

}  // namespace

ScanMotion::ScanMotion(const NominalState& end_state, std::span<const InertialSegment> segments,
                       const Pose& T_body_lidar, double gravity) {
  const Pose T_end_odom = end_state.T_odom_body().inverse();
  const auto knot = [&](const NominalState& state) {
    const Pose T_end_lidar = T_end_odom * state.T_odom_body() * T_body_lidar;
    return Knot{T_end_lidar.R().cast<float>(), T_end_lidar.translation.cast<float>()};
  };
  const Time end = segments.empty() ? 0 : segments.back().end;
  begin_ = end;
  if (!segments.empty()) {
    knots_.reserve(static_cast<std::size_t>((end - segments.front().begin) / kStep + 1));
  }
  knots_.push_back(knot(end_state));
  NominalState later = end_state;
  for (std::size_t i = segments.size(); i-- > 0;) {
    const InertialSegment& segment = segments[i];
    for (Time at = begin_ - kStep; at >= segment.begin; at -= kStep) {
      const double back = to_seconds(at - segment.end);
      knots_.push_back(knot(propagate_state(later, segment, back, gravity)));
      begin_ = at;
    }
    later = propagate_state(later, segment, to_seconds(segment.begin - segment.end), gravity);
  }
  std::reverse(knots_.begin(), knots_.end());
}

Eigen::Vector3f ScanMotion::deskew(const Eigen::Vector3f& point, Time time) const {
  const auto last = static_cast<Time>(knots_.size()) - 1;
  const Duration since = std::clamp<Duration>(time - begin_, 0, last * kStep);
  const auto i = static_cast<std::size_t>(since / kStep);
  const Knot& a = knots_[i];
  const Eigen::Vector3f early = a.R * point + a.t;
  if (i + 1 >= knots_.size()) return early;
  const Knot& b = knots_[i + 1];
  const float fraction = static_cast<float>(since % kStep) / static_cast<float>(kStep);
  return early + fraction * (b.R * point + b.t - early);
}

void deskew(const LidarScan& scan, std::span<const int> indices, const ScanMotion& motion,
            std::vector<Eigen::Vector3f>& points) {
  points.clear();
  for (int index : indices) {
    const LidarPoint& point = scan.points[static_cast<std::size_t>(index)];
    points.push_back(motion.deskew(point.position, scan.stamp + point.time_offset_ns));
  }
}

}  // namespace aims
