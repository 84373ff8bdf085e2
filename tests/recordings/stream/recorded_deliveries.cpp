// SPDX-License-Identifier: BSD-3-Clause
#include "tests/recordings/stream/recorded_deliveries.hpp"

#include <gtest/gtest.h>

#include <cstring>

namespace aims::test {
namespace {

template <class Fixed>
bool same_bits(const Fixed& a, const Fixed& b) {
  return std::memcmp(a.data(), b.data(), sizeof(*a.data()) * a.size()) == 0;
}

bool same(const Pose& a, const Pose& b) {
  return same_bits(a.rotation.coeffs(), b.rotation.coeffs()) &&
         same_bits(a.translation, b.translation);
}

bool same(const ImuSample& a, const ImuSample& b) {
  if (a.orientation.has_value() != b.orientation.has_value()) return false;
  if (a.orientation && !same_bits(a.orientation->coeffs(), b.orientation->coeffs())) return false;
  return a.stamp == b.stamp && same_bits(a.angular_velocity, b.angular_velocity) &&
         same_bits(a.specific_force, b.specific_force);
}

bool same(const LegOdometrySample& a, const LegOdometrySample& b) {
  return a.stamp == b.stamp && same(a.T_odom_base, b.T_odom_base) &&
         same_bits(a.linear_velocity, b.linear_velocity) &&
         same_bits(a.angular_velocity, b.angular_velocity) && a.contact == b.contact &&
         a.contact_force == b.contact_force && same_bits(a.joint_position, b.joint_position) &&
         same_bits(a.joint_velocity, b.joint_velocity);
}

bool same(const LidarPoint& a, const LidarPoint& b) {
  return same_bits(a.position, b.position) &&
         std::memcmp(&a.intensity, &b.intensity, sizeof(float)) == 0 &&
         a.time_offset_ns == b.time_offset_ns && a.ring == b.ring;
}

bool same(const LidarScanPtr& a, const LidarScanPtr& b) {
  if (a->stamp != b->stamp || a->end != b->end || a->points.size() != b->points.size()) {
    ADD_FAILURE() << "scan " << a->stamp << " to " << a->end << " with " << a->points.size()
                  << " points came back as " << b->stamp << " to " << b->end << " with "
                  << b->points.size();
    return false;
  }
  for (std::size_t i = 0; i < a->points.size(); ++i) {
    if (same(a->points[i], b->points[i])) continue;
    ADD_FAILURE() << "point " << i << ": " << a->points[i].position.transpose() << " i "
                  << a->points[i].intensity << " t " << a->points[i].time_offset_ns << " ring "
                  << a->points[i].ring << " came back as " << b->points[i].position.transpose()
                  << " i " << b->points[i].intensity << " t " << b->points[i].time_offset_ns
                  << " ring " << b->points[i].ring;
    return false;
  }
  return true;
}

template <class Kind>
std::vector<Kind> only(const std::vector<Delivery>& deliveries) {
  std::vector<Kind> found;
  for (const Delivery& each : deliveries) {
    if (const auto* kind = std::get_if<Kind>(&each.measurement)) found.push_back(*kind);
  }
  return found;
}

}  // namespace

Result<std::vector<Delivery>> read_all(RecordingReader& reader, Duration span) {
  std::vector<Delivery> deliveries;
  while (true) {
    const auto more = reader.advance(span, deliveries);
    if (!more) return tl::unexpected(more.error());
    if (!*more) return deliveries;
  }
}

void expect_same_deliveries(const std::vector<Delivery>& expected,
                            const std::vector<Delivery>& actual) {
  ASSERT_EQ(expected.size(), actual.size());
  for (std::size_t i = 0; i < expected.size(); ++i) {
    ASSERT_EQ(expected[i].arrival, actual[i].arrival) << "delivery " << i;
    const auto& a = expected[i].measurement;
    const auto& b = actual[i].measurement;
    ASSERT_EQ(a.index(), b.index()) << "delivery " << i;
    const bool equal = std::visit(
        [&](const auto& each) { return same(each, std::get<std::decay_t<decltype(each)>>(b)); }, a);
    ASSERT_TRUE(equal) << "delivery " << i << " of kind " << a.index();
  }
}

void expect_same_pose(const Pose& expected, const Pose& actual) {
  EXPECT_TRUE(same(expected, actual))
      << actual.translation.transpose() << ", " << actual.rotation.coeffs().transpose();
}

std::vector<LidarScanPtr> scans_of(const std::vector<Delivery>& deliveries) {
  return only<LidarScanPtr>(deliveries);
}
std::vector<LegOdometrySample> legs_of(const std::vector<Delivery>& deliveries) {
  return only<LegOdometrySample>(deliveries);
}
std::vector<ImuSample> imu_of(const std::vector<Delivery>& deliveries) {
  return only<ImuSample>(deliveries);
}

}  // namespace aims::test
