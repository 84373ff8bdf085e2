// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/lidar/deskew.hpp"

#include <algorithm>

namespace aims {
namespace {

/// Spacing of the knots; points are interpolated linearly between them.
constexpr Duration kStep = kMillisecond;

}  // namespace

ScanMotion::Knot ScanMotion::knot(const Pose& T_end_lidar) {
  const Eigen::Matrix3f R = T_end_lidar.R().cast<float>();
  const Eigen::Vector3f t = T_end_lidar.translation.cast<float>();
  const auto lanes = [](const auto& v) { return Float4{v.x(), v.y(), v.z(), 0.0F}; };
  return {{lanes(R.col(0)), lanes(R.col(1)), lanes(R.col(2))}, lanes(t)};
}

void ScanMotion::assign(const NominalState& end_state, std::span<const InertialSegment> segments,
                        const Pose& T_body_lidar, double gravity) {
  const Pose T_end_odom = end_state.T_odom_body().inverse();
  const auto at_state = [&](const NominalState& state) {
    return knot(T_end_odom * state.T_odom_body() * T_body_lidar);
  };
  begin_ = segments.empty() ? 0 : segments.back().end;
  knots_.clear();
  knots_.push_back(at_state(end_state));
  NominalState later = end_state;
  for (std::size_t i = segments.size(); i-- > 0;) {
    const InertialSegment& segment = segments[i];
    for (Time at = begin_ - kStep; at >= segment.begin; at -= kStep) {
      const double back = to_seconds(at - segment.end);
      knots_.push_back(at_state(propagate_state(later, segment, back, gravity)));
      begin_ = at;
    }
    later = propagate_state(later, segment, to_seconds(segment.begin - segment.end), gravity);
  }
  std::reverse(knots_.begin(), knots_.end());
}

Eigen::Vector3f ScanMotion::deskew(const Eigen::Vector3f& point, Time time) const {
  const auto last = static_cast<float>(knots_.size() - 1);
  const auto steps = static_cast<float>(time - begin_) / static_cast<float>(kStep);
  const float at = std::clamp(steps, 0.0F, last);
  const auto i = static_cast<std::size_t>(at);
  const Float4 early = knots_[i].apply(point);
  const Float4 late = knots_[std::min(i + 1, knots_.size() - 1)].apply(point);
  const Float4 deskewed = early + (at - static_cast<float>(i)) * (late - early);
  return {deskewed[0], deskewed[1], deskewed[2]};
}

namespace {

template <class Points>
void deskew_into(const LidarScan& scan, std::span<const int> indices, const ScanMotion& motion,
                 Points& points) {
  points.clear();
  for (int index : indices) {
    const LidarPoint& point = scan.points[static_cast<std::size_t>(index)];
    points.push_back(motion.deskew(point.position, scan.stamp + point.time_offset_ns));
  }
}

}  // namespace

void deskew(const LidarScan& scan, std::span<const int> indices, const ScanMotion& motion,
            std::vector<Eigen::Vector3f>& points) {
  deskew_into(scan, indices, motion, points);
}

void deskew(const LidarScan& scan, std::span<const int> indices, const ScanMotion& motion,
            PointBlocks& points) {
  deskew_into(scan, indices, motion, points);
}

}  // namespace aims
