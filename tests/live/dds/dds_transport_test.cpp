// SPDX-License-Identifier: BSD-3-Clause
#include "live/dds/dds_transport.hpp"

#include <dds/dds.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstdlib>
#include <functional>
#include <random>

#include "live/dds/raw_type.hpp"

namespace aims {
namespace {

/// Whether nobody on this machine has the port; one of TCP is held as long as the process lives.
bool take_port(std::uint32_t port, int type) {
  const int held = socket(AF_INET, type | SOCK_CLOEXEC, 0);
  sockaddr_in address = {};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<std::uint16_t>(port));
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  const bool free = bind(held, reinterpret_cast<const sockaddr*>(&address), sizeof(address)) == 0;
  if (!free || type == SOCK_DGRAM) close(held);
  return free;
}

/// A domain of its own for each test process, away from those of robots (0 to 99): it holds a port
/// of TCP, which DDS does not use, and nobody has those of UDP that its participants would have.
std::uint32_t own_domain() {
  static const std::uint32_t domain = [] {
    for (std::uint32_t i = 0; i < 100; ++i) {
      const std::uint32_t found = 100 + (static_cast<std::uint32_t>(getpid()) + i) % 100;
      const std::uint32_t port = 7400 + 250 * found;
      bool free = true;
      for (std::uint32_t p = 10; free && p < 30; ++p) free = take_port(port + p, SOCK_DGRAM);
      if (free && take_port(port, SOCK_STREAM)) return found;
    }
    ADD_FAILURE() << "no free domain of DDS";
    return 100U;
  }();
  return domain;
}

/// Random bytes behind the header of CDR.
std::vector<std::byte> payload(std::size_t size, unsigned seed) {
  std::mt19937 random(seed);
  std::vector<std::byte> bytes(size);
  for (std::byte& each : bytes) each = static_cast<std::byte>(random());
  bytes[0] = std::byte{0};
  bytes[1] = std::byte{1};
  bytes[2] = bytes[3] = std::byte{0};
  return bytes;
}

class DdsTransportTest : public testing::Test {
 protected:
  void SetUp() override {
    setenv("CYCLONEDDS_URI", "file://" AIMS_SOURCE_DIR "/tests/live/dds/loopback.xml", 1);
    sender_ = connect();
    receiver_ = connect();
  }

  std::unique_ptr<DdsTransport> connect(bool source_time = false) const {
    auto made = DdsTransport::connect(
        {.domain = own_domain(), .node = "test", .source_time = source_time, .max_blocking = 5.0});
    EXPECT_TRUE(made) << made.error().message;
    return std::move(*made);
  }

  /// Calls `done` until it is true, for a minute at most.
  static bool eventually(const std::function<bool()>& done) {
    for (int i = 0; i < 6000; ++i) {
      if (done()) return true;
      usleep(10'000);
    }
    return false;
  }

  /// Subscribes once the topic is found.
  void subscribe(const std::string& topic, const std::string& type) {
    ASSERT_TRUE(eventually([&] { return receiver_->topics().contains(topic); }));
    EXPECT_EQ(receiver_->topics().at(topic), type);
    receiver_->subscribe(topic, type);
  }

  std::optional<LiveMessage> received() { return receiver_->wait(60.0); }

  std::unique_ptr<DdsTransport> sender_;
  std::unique_ptr<DdsTransport> receiver_;
};

TEST_F(DdsTransportTest, BytesArriveAsTheyWereSent) {
  const std::size_t cloud =
      sender_->advertise("/lidar/points", {"sensor_msgs/PointCloud2", {}, {}}, false);
  subscribe("/lidar/points", "sensor_msgs/PointCloud2");
  ASSERT_TRUE(eventually([&] { return sender_->heard(cloud); }));
  // From one packet to hundreds of fragments, of any length modulo four: RTPS pads.
  unsigned seed = 1;
  for (const std::size_t size : {4U, 5U, 1001U, 65537U, 633'602U, 2'883'587U}) {
    const auto sent = payload(size, seed++);
    ASSERT_TRUE(sender_->publish_at(cloud, 123'456'789'012'345'678, sent));
    const auto message = received();
    ASSERT_TRUE(message) << size;
    EXPECT_EQ(message->connection->topic, "/lidar/points");
    EXPECT_EQ(message->connection->format, kRos2Format);
    EXPECT_EQ(message->data, sent) << size;
  }
}

TEST_F(DdsTransportTest, ArrivalIsTheTimeOfSendingToTheNanosecondWhereAskedFor) {
  receiver_ = connect(true);
  const std::size_t topic = sender_->advertise("/imu/data", {"sensor_msgs/Imu", {}, {}}, false);
  subscribe("/imu/data", "sensor_msgs/Imu");
  ASSERT_TRUE(eventually([&] { return sender_->heard(topic); }));
  const auto sent = payload(100, 7);
  std::mt19937_64 random(7);
  for (int i = 0; i < 1000; ++i) {
    const auto time = static_cast<std::int64_t>(random() % 4'000'000'000'000'000'000ULL) + 1;
    ASSERT_TRUE(sender_->publish_at(topic, time, sent));
    const auto message = received();
    ASSERT_TRUE(message);
    EXPECT_EQ(message->arrival, time);
  }
}

TEST_F(DdsTransportTest, WhatIsSentByThisComputersClockComesWithWhatWasPlayedLast) {
  receiver_ = connect(true);
  const std::size_t topic = sender_->advertise("/imu/data", {"sensor_msgs/Imu", {}, {}}, false);
  subscribe("/imu/data", "sensor_msgs/Imu");
  ASSERT_TRUE(eventually([&] { return sender_->heard(topic); }));
  const auto arrival = [&](Time sent) {
    EXPECT_TRUE(sender_->publish_at(topic, sent, payload(100, 7)));
    const auto message = received();
    return message ? message->arrival : -1;
  };
  EXPECT_EQ(arrival(wall_time()), 0) << "nothing was played";
  EXPECT_EQ(arrival(5 * kSecond), 5 * kSecond);
  EXPECT_EQ(arrival(wall_time()), 5 * kSecond);
  EXPECT_EQ(arrival(6 * kSecond), 6 * kSecond);
}

TEST_F(DdsTransportTest, TheNodeThatBeganFirstPrecedesTheOther) {
  sender_->advertise("/aims/odometry", {"nav_msgs/Odometry", {}, {}}, false);
  receiver_->advertise("/aims/odometry", {"nav_msgs/Odometry", {}, {}}, false);
  EXPECT_TRUE(eventually([&] { return receiver_->preceded("/aims/odometry"); }));
  EXPECT_TRUE(eventually([&] { return sender_->topics().contains("/aims/odometry"); }));
  EXPECT_FALSE(sender_->preceded("/aims/odometry"));
}

TEST_F(DdsTransportTest, BytesThatAreNoMessageAreNotSent) {
  const std::size_t topic = sender_->advertise("/imu/data", {"sensor_msgs/Imu", {}, {}}, false);
  EXPECT_FALSE(sender_->publish_at(topic, 1, std::vector<std::byte>(3)));
  EXPECT_TRUE(sender_->publish_at(topic, 1, std::vector<std::byte>(4)));
}

TEST_F(DdsTransportTest, StaysOnThisComputerWhereRosDoes) {
  unsetenv("CYCLONEDDS_URI");
  setenv("ROS_LOCALHOST_ONLY", "1", 1);
  EXPECT_NE(connect()->place().find("on this computer alone"), std::string::npos);
  unsetenv("ROS_LOCALHOST_ONLY");
}

TEST_F(DdsTransportTest, LateSubscribersReceiveWhatALatchingTopicHeld) {
  const std::size_t topic = sender_->advertise("/tf_static", {"tf2_msgs/TFMessage", {}, {}}, true);
  const auto sent = payload(64, 3);
  sender_->publish(topic, sent);
  subscribe("/tf_static", "tf2_msgs/TFMessage");
  const auto message = received();
  ASSERT_TRUE(message);
  EXPECT_EQ(message->data, sent);
  EXPECT_TRUE(message->connection->latching);
}

/// A publisher of the network that offers less than the first one of its topic did.
class BestEffort {
 public:
  BestEffort(const std::string& topic, const std::string& type)
      : participant_(dds_create_participant(own_domain(), nullptr, nullptr)) {
    ddsi_sertype* raw = make_raw_type(dds_type(type));
    const dds_entity_t made = dds_create_topic_sertype(participant_, dds_topic(topic).c_str(), &raw,
                                                       nullptr, nullptr, nullptr);
    dds_qos_t* qos = dds_create_qos();
    dds_qset_reliability(qos, DDS_RELIABILITY_BEST_EFFORT, 0);
    writer_ = dds_create_writer(participant_, made, qos, nullptr);
    dds_delete_qos(qos);
  }
  ~BestEffort() { dds_delete(participant_); }

  void send(const std::vector<std::byte>& bytes) const {
    const std::span<const std::byte> sample(bytes);
    dds_write(writer_, &sample);
  }

 private:
  dds_entity_t participant_;
  dds_entity_t writer_ = 0;
};

TEST_F(DdsTransportTest, AnIncompatiblePublisherIsReportedAndThenHeard) {
  sender_->advertise("/imu/data", {"sensor_msgs/Imu", {}, {}}, false);
  subscribe("/imu/data", "sensor_msgs/Imu");
  const BestEffort other("/imu/data", "sensor_msgs/Imu");
  const auto sent = payload(200, 5);
  std::optional<LiveMessage> message;
  ASSERT_TRUE(eventually([&] {
    other.send(sent);
    message = receiver_->wait(0.0);
    return message.has_value();
  }));
  EXPECT_EQ(message->data, sent);
  const auto problems = receiver_->take_problems();
  ASSERT_GE(problems.size(), 1U);
  EXPECT_NE(problems[0].find("/imu/data does not match in reliability"), std::string::npos)
      << problems[0];
}

TEST_F(DdsTransportTest, TwoPublishersOfATopicAreReported) {
  sender_->advertise("/imu/data", {"sensor_msgs/Imu", {}, {}}, false);
  subscribe("/imu/data", "sensor_msgs/Imu");
  EXPECT_TRUE(receiver_->take_problems().empty());
  const auto second = connect();
  second->advertise("/imu/data", {"sensor_msgs/Imu", {}, {}}, false);
  std::vector<std::string> problems;
  ASSERT_TRUE(eventually([&] {
    receiver_->wait(0.0);
    problems = receiver_->take_problems();
    return !problems.empty();
  }));
  EXPECT_EQ(problems, std::vector<std::string>{"/imu/data has 2 publishers: expected one"});
}

TEST_F(DdsTransportTest, APublisherOfAnotherTypeIsReported) {
  sender_->advertise("/imu/data", {"sensor_msgs/Imu", {}, {}}, false);
  subscribe("/imu/data", "sensor_msgs/Imu");
  const auto other = connect();
  other->advertise("/imu/data", {"std_msgs/String", {}, {}}, false);
  std::vector<std::string> problems;
  ASSERT_TRUE(eventually([&] {
    receiver_->wait(0.0);
    const auto more = receiver_->take_problems();
    problems.insert(problems.end(), more.begin(), more.end());
    return !problems.empty();
  }));
  EXPECT_EQ(
      problems[0],
      "a publisher of /imu/data sends std_msgs/String: expected sensor_msgs/Imu, it is not heard");
}

TEST_F(DdsTransportTest, BestEffortPublishersAreHeard) {
  const BestEffort sensor("/imu/data", "sensor_msgs/Imu");
  subscribe("/imu/data", "sensor_msgs/Imu");
  const auto sent = payload(200, 6);
  ASSERT_TRUE(eventually([&] {
    sensor.send(sent);
    const auto message = receiver_->wait(0.0);
    return message && message->data == sent;
  }));
  EXPECT_TRUE(receiver_->take_problems().empty());
}

TEST_F(DdsTransportTest, TopicsOfTheNodeItselfAndOfNoRosAreNotListed) {
  receiver_->advertise("~odometry", {"nav_msgs/Odometry", {}, {}}, false);
  sender_->advertise("/clock", {"rosgraph_msgs/Clock", {}, {}}, false);
  const std::map<std::string, std::string> expected{{"/clock", "rosgraph_msgs/Clock"}};
  EXPECT_TRUE(eventually([&] { return receiver_->topics() == expected; }));
  sender_.reset();
  EXPECT_TRUE(eventually([&] { return receiver_->topics().empty(); })) << "it has gone";
}

}  // namespace
}  // namespace aims
