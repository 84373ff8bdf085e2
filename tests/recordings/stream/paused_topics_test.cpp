// SPDX-License-Identifier: BSD-3-Clause
// Topics of a robot that pause, start late or stop.
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "recordings/bag/wrapped_source.hpp"
#include "recordings/source/recording_file.hpp"
#include "recordings/stream/recording_writer.hpp"
#include "recordings/topics/recording_topics.hpp"
#include "tests/recordings/legs/trot.hpp"
#include "tests/recordings/stream/recorded_deliveries.hpp"
#include "tests/recordings/stream/robot_recording.hpp"

namespace aims {
namespace {

using test::kStart;

using Topics = std::vector<std::string_view>;

/// A recording without the messages of topics in some time since its start.
class Paused final : public WrappedSource {
 public:
  Paused(std::unique_ptr<MessageSource> recording, Topics topics, Duration from, Duration to)
      : WrappedSource(std::move(recording)), topics_(std::move(topics)), from_(from), to_(to) {}

  Result<std::optional<BagMessage>> next() override {
    for (;;) {
      auto message = read();
      if (!message || !*message) return message;
      const std::string& topic = (*message)->connection->topic;
      if (std::ranges::find(topics_, topic) == topics_.end()) return message;
      const Duration since = (*message)->record_time - kStart;
      if (since < from_ || since >= to_) return message;
    }
  }

 private:
  Topics topics_;
  Duration from_, to_;
};

class PausedTopics : public test::RecordingTest {
 protected:
  /// 40 s of IMU, leg odometry, joints, contacts and clouds.
  void record() {
    const test::Trot trot;
    auto writer = RecordingWriter::create(bag(), SensorRig{}, "seed: 1");
    ASSERT_TRUE(writer) << writer.error().message;
    for (int k = 0; k < 4000; ++k) {
      const Time now = kStart + k * 10 * kMillisecond;
      ImuSample imu;
      imu.stamp = now;
      imu.specific_force = {0.0, 0.0, 9.81};
      ASSERT_TRUE(writer->write_imu(ImuOutput::kMain, now, imu));
      LegOdometrySample legs;
      legs.stamp = now;
      legs.linear_velocity.x() = test::Trot::kSpeed;
      legs.T_odom_base.translation.x() = test::Trot::kSpeed * 0.01 * k;
      const JointVector q = trot.angles(0.01 * k + 0.003), dq = trot.rates(0.01 * k + 0.003);
      std::ranges::copy(q, legs.joint_position.begin());
      std::ranges::copy(dq, legs.joint_velocity.begin());
      legs.contact = trot.contact(0.01 * k + 0.003);
      ASSERT_TRUE(writer->write_legs(now, legs));
      if (k % 10 != 0) continue;
      LidarScan scan;
      scan.stamp = now - 100 * kMillisecond;
      scan.end = now;
      scan.points.resize(20);
      for (std::size_t i = 0; i < scan.points.size(); ++i) {
        scan.points[i].time_offset_ns = 5'000'000 * static_cast<int>(i);
        scan.points[i].position = {2.0F + 0.1F * static_cast<float>(i), 1.0F, 0.5F};
      }
      ASSERT_TRUE(writer->write_scan(now, scan));
    }
    ASSERT_TRUE(writer->close());
  }

  /// The warnings of the end, one a line, where topics pause.
  std::string warnings(const Topics& topics, double from, double to, bool odometry = true) {
    auto source = open_recording(bag());
    EXPECT_TRUE(source);
    RecordingConfig config;
    if (!odometry) config.topics.leg_odometry = "none";
    auto reader = RecordingReader::open(
        std::make_unique<Paused>(std::move(*source), topics, from_seconds(from), from_seconds(to)),
        config);
    EXPECT_TRUE(reader) << reader.error().message;
    const std::size_t before = reader->setup().warnings.size();
    EXPECT_TRUE(test::read_all(*reader));
    std::string found;
    for (std::size_t i = before; i < reader->setup().warnings.size(); ++i) {
      found += reader->setup().warnings[i].text + "\n";
    }
    return found;
  }
};

TEST_F(PausedTopics, JointsAndContactsBesideLegOdometryAreNamed) {
  record();
  EXPECT_EQ(warnings({kImuTopic}, 0.0, 0.0), "");
  for (const std::string_view topic : {kJointStatesTopic, kFootContactsTopic}) {
    EXPECT_TRUE(warnings({topic}, 20.0, 32.0)
                    .starts_with(std::string(topic) + ": 1200 of 4000 messages are missing, by the "
                                                      "gaps in their stamps (30.0 %), 1200 of "))
        << warnings({topic}, 20.0, 32.0);
    EXPECT_EQ(warnings({topic}, 20.0, 29.0), "") << "a short pause";
  }
  EXPECT_TRUE(warnings({kFootContactsTopic}, 20.0, 32.0, false)
                  .starts_with(std::string(kFootContactsTopic) + ": 1200 of 4000 messages"))
      << "beside joints";
}

TEST_F(PausedTopics, OfLegsOfWhichAllPausesOneTopicIsNamed) {
  record();
  const auto all = [this](double from, double to) {
    return warnings({kLegOdometryTopic, kJointStatesTopic, kFootContactsTopic}, from, to);
  };
  for (const std::string& found : {all(20.0, 32.0), all(25.0, 100.0)}) {
    EXPECT_TRUE(found.starts_with(std::string(kLegOdometryTopic) + ": ")) << found;
    EXPECT_EQ(std::ranges::count(found, '\n'), 1) << found;
  }
}

TEST_F(PausedTopics, WhatStartsLateOrStopsIsNamed) {
  record();
  for (const std::string_view topic :
       {kLidarTopic, kLegOdometryTopic, kJointStatesTopic, kFootContactsTopic}) {
    const std::string name(topic);
    EXPECT_NE(warnings({topic}, 25.01, 100.0)
                  .find(name + ": the last message was recorded 15.0 s before the last one of "
                               "another sensor: has its driver stopped?"),
              std::string::npos)
        << name << "\n"
        << warnings({topic}, 25.01, 100.0);
    EXPECT_EQ(warnings({topic}, 32.0, 100.0), "") << name;
  }
  EXPECT_EQ(
      warnings({kLidarTopic}, 0.0, 15.0),
      std::string(kLidarTopic) +
          ": the first message was recorded 15.0 s after the first one of another sensor: was "
          "its driver started late?\n");
  EXPECT_EQ(warnings({kLidarTopic}, 0.0, 9.0), "");
}

}  // namespace
}  // namespace aims
