// SPDX-License-Identifier: BSD-3-Clause
#include "bench/run/record.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <vector>

#include "core/files/atomic_file.hpp"
#include "core/files/tum.hpp"
#include "recordings/bag/bag_reader.hpp"
#include "recordings/messages/message_decoder.hpp"
#include "recordings/topics/recording_topics.hpp"
#include "sim/simulation.hpp"
#include "tests/support/temporary_folder.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;

/// Two metres of a corridor with every kind of fault on the links.
Scenario faulty_walk() {
  Scenario scenario;
  scenario.name = "short";
  scenario.simulation.scene.corridor.length = 10.0;
  scenario.simulation.route.points = {{"a", 0.0, 0.0}, {"b", 2.0, 0.0}};
  scenario.simulation.route.stand_before = 1.0;
  scenario.simulation.lidar.columns = 180;
  scenario.simulation.links.leg_odometry.loss = 0.1;
  scenario.simulation.links.imu.jitter = 0.01;
  scenario.simulation.links.lidar.delay = 0.02;
  return scenario;
}

bool go_on(const Progress&) { return true; }

/// A message and what it says, kept beyond the reader's step.
struct Kept {
  std::string topic;
  Time record_time = 0;
  std::shared_ptr<std::vector<std::byte>> bytes;
  MessageView view;
};

std::vector<Kept> messages_in(const fs::path& bag) {
  BagReader reader = BagReader::open(bag).value();
  std::map<std::string, MessageDecoder> decoders;
  std::vector<Kept> kept;
  while (const auto message = reader.next().value()) {
    const BagConnection& from = *message->connection;
    if (!decoders.contains(from.type)) {
      decoders.emplace(from.type, MessageDecoder::create(from.type, from.definition).value());
    }
    auto bytes =
        std::make_shared<std::vector<std::byte>>(message->data.begin(), message->data.end());
    MessageView view = decoders.at(from.type).decode(*bytes).value();
    kept.push_back({from.topic, message->record_time, std::move(bytes), std::move(view)});
  }
  return kept;
}

std::vector<Kept> of_topic(const std::vector<Kept>& all, std::string_view topic) {
  std::vector<Kept> some;
  std::copy_if(all.begin(), all.end(), std::back_inserter(some),
               [topic](const Kept& each) { return each.topic == topic; });
  return some;
}

class Recorded : public ::testing::Test {
 protected:
  void SetUp() override {
    scenario_.simulation.fast_imu_rate = 200.0;
    const RecordOptions options = {.seed = 5, .bag = folder_.path() / "walk.bag"};
    outcome_ = record(scenario_, options, go_on).value();
    Simulation simulation = Simulation::create(scenario_.simulation, 5).value();
    while (simulation.advance(kSecond, deliveries_)) {
    }
    truth_ = simulation.truth();
    messages_ = messages_in(options.bag);
  }

  template <class Sample>
  std::vector<std::pair<Time, Sample>> delivered() const {
    std::vector<std::pair<Time, Sample>> samples;
    for (const Delivery& each : deliveries_) {
      if (const auto* sample = std::get_if<Sample>(&each.measurement)) {
        samples.emplace_back(each.arrival, *sample);
      }
    }
    return samples;
  }

  Scenario scenario_ = faulty_walk();
  TemporaryFolder folder_;
  RecordOutcome outcome_;
  std::vector<Delivery> deliveries_;
  Truth truth_;
  std::vector<Kept> messages_;
};

TEST_F(Recorded, HoldsEveryDeliveryBitForBitInOrderOfArrival) {
  const auto imu = delivered<ImuSample>();
  const auto imu_messages = of_topic(messages_, kImuTopic);
  ASSERT_EQ(imu_messages.size(), imu.size());
  for (std::size_t i = 0; i < imu.size(); ++i) {
    const Kept& message = imu_messages[i];
    EXPECT_EQ(message.record_time, imu[i].first);
    EXPECT_EQ(message.view.time("header.stamp"), imu[i].second.stamp);
    EXPECT_EQ(message.view.number("linear_acceleration.y"), imu[i].second.specific_force.y());
    EXPECT_EQ(message.view.number("angular_velocity.z"), imu[i].second.angular_velocity.z());
  }
  const auto legs = delivered<LegOdometrySample>();
  const auto leg_messages = of_topic(messages_, kLegOdometryTopic);
  const auto joint_messages = of_topic(messages_, kJointStatesTopic);
  const auto contact_messages = of_topic(messages_, kFootContactsTopic);
  ASSERT_EQ(leg_messages.size(), legs.size());
  ASSERT_EQ(joint_messages.size(), legs.size());
  ASSERT_EQ(contact_messages.size(), legs.size());
  for (std::size_t i = 0; i < legs.size(); ++i) {
    const LegOdometrySample& sample = legs[i].second;
    EXPECT_EQ(leg_messages[i].view.number("pose.pose.orientation.w"),
              sample.T_odom_base.rotation.w());
    EXPECT_EQ(leg_messages[i].view.number("twist.twist.linear.x"), sample.linear_velocity.x());
    EXPECT_EQ(joint_messages[i].view.numbers("velocity")->at(11), sample.joint_velocity[11]);
    EXPECT_EQ(contact_messages[i]
                  .view.number("contact[2]")
                  .value_or(contact_messages[i].view.numbers("contact")->at(2)),
              sample.contact[2] ? 1.0 : 0.0);
    ASSERT_TRUE(sample.contact_force);
    EXPECT_EQ(contact_messages[i].view.numbers("force")->at(3), (*sample.contact_force)[3]);
  }
}

TEST_F(Recorded, CloudsHaveTheLayoutThatOtherSystemsRead) {
  const auto scans = delivered<LidarScanPtr>();
  const auto clouds = of_topic(messages_, kLidarTopic);
  ASSERT_EQ(clouds.size(), scans.size());
  for (std::size_t i = 0; i < scans.size(); ++i) {
    const MessageView& cloud = clouds[i].view;
    const LidarScan& scan = *scans[i].second;
    EXPECT_EQ(clouds[i].record_time, scans[i].first);
    EXPECT_EQ(cloud.time("header.stamp"), scan.stamp);
    EXPECT_EQ(cloud.number("height"), 1.0);
    EXPECT_EQ(cloud.number("width"), static_cast<double>(scan.points.size()));
    EXPECT_EQ(cloud.number("point_step"), 22.0);
    EXPECT_EQ(cloud.number("is_dense"), 1.0);
    const auto data = cloud.bytes("data").value();
    ASSERT_EQ(data.size(), 22 * scan.points.size());
    for (std::size_t k = 0; k < scan.points.size(); k += 97) {
      const std::byte* point = data.data() + 22 * k;
      EXPECT_EQ(number_at(point + 4, NumberType::kFloat32), scan.points[k].position.y());
      EXPECT_EQ(number_at(point + 12, NumberType::kFloat32), scan.points[k].intensity);
      EXPECT_EQ(number_at(point + 16, NumberType::kUint16), scan.points[k].ring);
      EXPECT_EQ(from_seconds(number_at(point + 18, NumberType::kFloat32)),
                scan.points[k].time_offset_ns);
    }
  }
}

TEST_F(Recorded, HoldsTheTruthOfBothFramesAndSaysWhereItCameFrom) {
  const Trajectory truth = read_tum(outcome_.truth).value();
  const auto imu = of_topic(messages_, kTruthImuTopic);
  const auto lidar = of_topic(messages_, kTruthLidarTopic);
  ASSERT_EQ(imu.size(), truth.size());
  ASSERT_EQ(lidar.size(), truth.size());
  for (std::size_t i = 0; i < truth.size(); i += 13) {
    EXPECT_EQ(imu[i].view.time("header.stamp"), truth[i].stamp);
    EXPECT_EQ(imu[i].view.number("pose.pose.position.x"), truth[i].pose.translation.x());
    const Eigen::Vector3d mast(0.03, 0.0, 0.16);
    EXPECT_NEAR(lidar[i].view.number("pose.pose.position.x").value(), (truth[i].pose * mast).x(),
                1e-9);
  }
  const auto origin = of_topic(messages_, kScenarioTopic);
  ASSERT_EQ(origin.size(), 1U);
  const std::string text(origin.front().view.text("data").value());
  EXPECT_NE(text.find("seed: 5\n"), std::string::npos) << text.substr(0, 200);
  EXPECT_NE(text.find("fast_imu_rate: 200"), std::string::npos);
  const auto waypoint_times = of_topic(messages_, kWaypointTimesTopic);
  ASSERT_EQ(waypoint_times.size(), 1U);
  EXPECT_EQ(waypoint_times.front().view.text("data"), read_file(outcome_.waypoint_times).value());
}

TEST_F(Recorded, TheSecondImuTopicIsFasterAndOriented) {
  const auto fast = of_topic(messages_, kFastImuTopic);
  const auto slow = of_topic(messages_, kImuTopic);
  EXPECT_NEAR(static_cast<double>(fast.size()) / static_cast<double>(slow.size()), 4.0, 0.1);
  for (const Kept& each : fast) {
    double norm = 0.0;
    for (const char* part : {"x", "y", "z", "w"}) {
      norm += std::pow(each.view.number(std::string("orientation.") + part).value(), 2);
    }
    ASSERT_NEAR(norm, 1.0, 1e-9);
  }
}

TEST(Record, TwiceIsTheSameBytes) {
  TemporaryFolder folder;
  std::vector<std::string> bytes;
  for (const char* name : {"a.bag", "b.bag"}) {
    const RecordOptions options = {.seed = 2, .bag = folder.path() / name};
    ASSERT_TRUE(record(faulty_walk(), options, go_on));
    bytes.push_back(read_file(options.bag).value());
  }
  EXPECT_EQ(bytes[0], bytes[1]);
}

TEST(Record, ReplacesABagOnlyWhenTold) {
  TemporaryFolder folder;
  RecordOptions options = {.seed = 2, .bag = folder.path() / "walk.bag"};
  ASSERT_TRUE(write_file_atomically(options.bag, "mine"));
  const auto refused = record(faulty_walk(), options, go_on);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message.find("walk.bag"), std::string::npos) << refused.error().message;
  EXPECT_EQ(read_file(options.bag).value(), "mine");
  options.overwrite = true;
  EXPECT_TRUE(record(faulty_walk(), options, go_on));
  EXPECT_GT(fs::file_size(options.bag), 10'000U);
}

TEST(Record, StoppedEarlyHoldsWhatWasWalked) {
  TemporaryFolder folder;
  const RecordOptions options = {.seed = 2, .bag = folder.path() / "walk.bag"};
  const RecordOutcome outcome = record(faulty_walk(), options, [](const Progress& now) {
                                  return now.simulated_s < 1.5;
                                }).value();
  EXPECT_FALSE(outcome.complete);
  EXPECT_EQ(of_topic(messages_in(options.bag), kLidarTopic).size(), 19U)
      << "the last is on its way";
}

TEST(Record, LeavesOutWhatWouldNeedANegativeTimeAndSaysSo) {
  TemporaryFolder folder;
  Scenario scenario = faulty_walk();
  scenario.simulation.links.lidar.clock_offset = -0.05;
  const RecordOptions options = {.seed = 2, .bag = folder.path() / "walk.bag"};
  EXPECT_EQ(record(scenario, options, go_on).value().left_out, 1);
}

}  // namespace
}  // namespace aims
