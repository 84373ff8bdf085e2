// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <concepts>
#include <type_traits>

#include "core/measurements.hpp"

namespace aims {

/// A `Value` that may be read, or a const one that is written.
template <class Type, class Value>
concept MaybeConst = std::same_as<std::remove_const_t<Type>, Value>;

/// Hands every member of a measurement to `archive(member, ...)`, which writes or reads them in
/// this order: what stores measurements or sends them to another process has the members from here.
template <class Archive, MaybeConst<ImuSample> Sample>
bool visit_members(Archive& archive, Sample& sample) {
  return archive(sample.stamp, sample.angular_velocity, sample.specific_force, sample.orientation);
}

template <class Archive, MaybeConst<LegOdometrySample> Sample>
bool visit_members(Archive& archive, Sample& sample) {
  return archive(sample.stamp, sample.T_odom_base, sample.linear_velocity, sample.angular_velocity,
                 sample.contact, sample.joint_position, sample.joint_velocity,
                 sample.contact_force);
}

template <class Archive, MaybeConst<LidarPoint> Point>
bool visit_members(Archive& archive, Point& point) {
  return archive(point.position, point.intensity, point.time_offset_ns, point.ring);
}

template <class Archive, MaybeConst<LidarScan> Scan>
bool visit_members(Archive& archive, Scan& scan) {
  return archive(scan.stamp, scan.end, scan.points);
}

}  // namespace aims
