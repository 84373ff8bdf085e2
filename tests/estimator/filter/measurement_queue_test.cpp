// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/filter/measurement_queue.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace aims {
namespace {

constexpr double kImuRate = 50.0;     // [Hz]
constexpr double kMaxLegSpeed = 5.0;  // [m/s]

MeasurementQueue make_queue(const QueueConfig& config = {}) {
  return {config, ImuPropagationConfig{}, kImuRate, kMaxLegSpeed};
}

Delivery imu(int ms, int arrival_ms) {
  return {arrival_ms * kMillisecond,
          ImuSample{ms * kMillisecond, Eigen::Vector3d::Zero(), {0.0, 0.0, 9.81}}};
}
Delivery imu(int ms) { return imu(ms, ms); }

LegOdometrySample leg_sample(int ms) {
  LegOdometrySample sample;
  sample.stamp = ms * kMillisecond;
  return sample;
}
Delivery leg(int ms, int arrival_ms) { return {arrival_ms * kMillisecond, leg_sample(ms)}; }
Delivery leg(int ms) { return leg(ms, ms); }

Delivery lidar(int begin_ms, int end_ms) {
  auto scan = std::make_shared<LidarScan>();
  scan->stamp = begin_ms * kMillisecond;
  scan->end = end_ms * kMillisecond;
  return {end_ms * kMillisecond, scan};
}

std::vector<Time> drain(MeasurementQueue& queue) {
  std::vector<Time> stamps;
  while (auto next = queue.pop()) {
    stamps.push_back(std::visit(
        [](const auto& each) { return stamp_of(Measurement(each)) / kMillisecond; }, *next));
  }
  return stamps;
}

TEST(MeasurementQueue, SortsByStampWithinTheLag) {
  MeasurementQueue queue = make_queue();
  for (const Delivery& d : {leg(10, 30), leg(5, 31), lidar(0, 12), imu(40, 60), leg(7, 61)}) {
    queue.push(d);
  }
  queue.push(imu(120));
  EXPECT_EQ(drain(queue), (std::vector<Time>{5, 7, 10, 12}));
}

TEST(MeasurementQueue, HoldsCorrectionsThatTheImuDoesNotCoverYet) {
  MeasurementQueue queue = make_queue();
  queue.push(imu(20));
  queue.push(leg(25));
  queue.push(leg(100));
  EXPECT_TRUE(drain(queue).empty());
  queue.push(imu(40, 101));
  EXPECT_EQ(drain(queue), std::vector<Time>{25});
}

TEST(MeasurementQueue, StopsWaitingForAMissingImu) {
  MeasurementQueue queue = make_queue({});
  queue.push(leg(10));
  queue.push(leg(200));
  EXPECT_TRUE(drain(queue).empty());
  queue.push(leg(311));
  EXPECT_EQ(drain(queue), std::vector<Time>{10});
}

TEST(MeasurementQueue, CountsLateAndDuplicate) {
  MeasurementQueue queue = make_queue();
  for (const Delivery& d : {leg(10), leg(10), imu(20), imu(20), imu(200)}) queue.push(d);
  EXPECT_EQ(drain(queue), std::vector<Time>{10});
  queue.push(leg(10, 201));
  queue.push(leg(5, 202));
  queue.push(imu(8, 203));
  EXPECT_TRUE(drain(queue).empty());
  EXPECT_EQ(queue.counts().at("leg.duplicate"), 2);
  EXPECT_EQ(queue.counts().at("leg.late"), 1);
  EXPECT_EQ(queue.counts().at("imu.duplicate"), 1);
  EXPECT_EQ(queue.counts().at("imu.late"), 1);
}

TEST(MeasurementQueue, RejectsImplausibleMeasurements) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  MeasurementQueue queue = make_queue();
  LegOdometrySample broken = leg_sample(10);
  broken.linear_velocity.x() = nan;
  LegOdometrySample fast = leg_sample(15);
  fast.linear_velocity.x() = 100.0;
  queue.push({0, broken});
  queue.push({0, fast});
  queue.push({0, ImuSample{20 * kMillisecond, {nan, 0.0, 0.0}, Eigen::Vector3d::Zero()}});
  queue.push({0, ImuSample{20 * kMillisecond, {1e9, 0.0, 0.0}, Eigen::Vector3d::Zero()}});
  queue.push({0, LidarScanPtr{}});
  queue.push(lidar(10, 5));
  queue.push({0, leg_sample(1'000'000)});
  queue.close();
  EXPECT_TRUE(drain(queue).empty());
  EXPECT_EQ(queue.counts().at("leg.non_finite"), 1);
  EXPECT_EQ(queue.counts().at("leg.out_of_range"), 1);
  EXPECT_EQ(queue.counts().at("leg.ahead"), 1);
  EXPECT_EQ(queue.counts().at("imu.non_finite"), 1);
  EXPECT_EQ(queue.counts().at("imu.out_of_range"), 1);
  EXPECT_EQ(queue.counts().at("lidar.out_of_range"), 2);
}

TEST(MeasurementQueue, MemoryIsBounded) {
  MeasurementQueue queue = make_queue({.max_ahead = 10.0});
  for (int i = 0; i < static_cast<int>(kMaxHeld) + 900; ++i) {
    queue.push(leg(i, 0));
    queue.push(imu(i, 0));
  }
  EXPECT_LE(queue.imu().samples().size(), kMaxHeld);
  EXPECT_EQ(queue.counts().at("queue.overflow"), 900);
}

}  // namespace
}  // namespace aims
