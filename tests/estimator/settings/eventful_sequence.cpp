// SPDX-License-Identifier: BSD-3-Clause
#include "tests/estimator/settings/eventful_sequence.hpp"

#include <algorithm>
#include <iterator>
#include <optional>
#include <variant>

#include "tests/estimator/simulated_sequence.hpp"

namespace aims::testing {
namespace {

/// Time of the first step [s].
constexpr double kSetOff = 3.0;

bool within(Time time, double from, double to) {
  return time >= from_seconds(from) && time < from_seconds(to);
}

SimulationConfig short_route(int columns) {
  SimulationConfig config = straight_sequence(5.0, columns);
  config.route.points = {{"a", 0.0, 0.0}, {"b", 2.5, 0.0}, {"c", 5.0, 0.0}};
  config.route.stand_before = kSetOff;
  config.route.stand_at_points = 1.5;
  config.scene.ramp = {.start = 3.2, .length = 0.8, .grade = 0.06};
  return config;
}

/// The IMU is silent for 0.2 s and for 0.6 s, two samples are impossible, and one shakes the
/// standing robot, which ends its standstill only without hysteresis.
bool disturb(ImuSample& sample, Delivery&) {
  if (within(sample.stamp, 4.0, 4.2) || within(sample.stamp, 8.0, 8.6)) return false;
  if (within(sample.stamp, 2.6, 2.62)) sample.angular_velocity.x() = 0.04;
  if (within(sample.stamp, 5.0, 5.02)) sample.angular_velocity.x() = 60.0;
  if (within(sample.stamp, 5.5, 5.52)) sample.specific_force.x() = 500.0;
  return true;
}

/// Slips, lost contacts, a fast sample, late packets and packets with stamps ahead of their time.
bool disturb(LegOdometrySample& sample, Delivery& delivery) {
  const Time t = sample.stamp;
  if (within(t, 3.7, 3.8) || within(t, 6.6, 6.9)) return false;
  if (within(t, 4.4, 4.6)) sample.linear_velocity.x() += 1.5;
  if (within(t, 7.3, 8.5)) sample.linear_velocity.y() += 1.0;
  if (within(t, 4.7, 4.72)) sample.linear_velocity.x() = 20.0;
  if (within(t, 4.8, 4.9)) sample.contact = {true, false, false, false};
  if (within(t, 4.9, 5.0)) sample.contact = {};
  if (within(t, 5.2, 5.3)) sample.joint_velocity[1] += 4.0;
  if (within(t, 5.6, 5.62) || within(t, 8.2, 8.22)) delivery.arrival += 120 * kMillisecond;
  if (within(t, 9.0, 10.0)) delivery.arrival = from_seconds(9.0);
  return true;
}

/// Six scans are lost.
bool disturb(LidarScanPtr& scan, Delivery&) { return !within(scan->end, 5.8, 6.4); }

}  // namespace

RecordedStream eventful_sequence(int columns) {
  SimulatedSequence sequence = simulate(short_route(columns), 3);
  RecordedStream stream{{}, sequence.rig};
  for (Delivery& delivery : sequence.deliveries) {
    const bool kept =
        std::visit([&](auto& each) { return disturb(each, delivery); }, delivery.measurement);
    if (kept) stream.deliveries.push_back(delivery);
  }
  std::stable_sort(stream.deliveries.begin(), stream.deliveries.end(),
                   [](const Delivery& a, const Delivery& b) { return a.arrival < b.arrival; });
  return stream;
}

RecordedStream started_in_motion(const RecordedStream& stream) {
  RecordedStream moving{{}, stream.rig};
  std::copy_if(
      stream.deliveries.begin(), stream.deliveries.end(), std::back_inserter(moving.deliveries),
      [](const Delivery& delivery) { return delivery.arrival >= from_seconds(kSetOff + 1.0); });
  return moving;
}

}  // namespace aims::testing
