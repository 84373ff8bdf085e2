// SPDX-License-Identifier: BSD-3-Clause
// A node of another DDS implementation, Fast-DDS, as most ROS 2 installations use it.
//   fastdds_peer relay FROM TO TOPIC TYPE DURABILITY [TOPIC TYPE DURABILITY]...
//     passes samples on from one domain to another, under the names of DDS, until standard input
//     ends. DURABILITY: volatile or transient.
//   fastdds_peer odometry DOMAIN TOPIC
//     prints "matched" for each publisher found, then each nav_msgs/Odometry in one line, read by
//     Fast-CDR.
//   fastdds_peer clouds DOMAIN TOPIC COUNT RETURNS RELIABILITY
//     sends so many sensor_msgs/PointCloud2 at 10 Hz, once somebody listens, then five small ones,
//     by whose numbers it is known how many of the large ones were lost. RELIABILITY: reliable (it
//     waits until all are acknowledged) or best_effort.
#include <fastcdr/Cdr.h>
#include <fastcdr/FastBuffer.h>

#include <fastdds/rtps/transport/UDPv4TransportDescriptor.h>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/publisher/DataWriter.hpp>
#include <fastdds/dds/publisher/Publisher.hpp>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/DataReaderListener.hpp>
#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>
#include <fastdds/dds/topic/TopicDataType.hpp>
#include <fastdds/dds/topic/TypeSupport.hpp>
#include <functional>
#include <iostream>
#include <memory>
#include <string>
#include <thread>
#include <vector>

namespace {

namespace fast = eprosima::fastdds::dds;
namespace rtps = eprosima::fastrtps::rtps;
using Bytes = std::vector<rtps::octet>;

/// A sample is its bytes, with the header of CDR.
class BytesType : public fast::TopicDataType {
 public:
  explicit BytesType(const std::string& name) {
    setName(name.c_str());
    m_typeSize = 1 << 24;
    m_isGetKeyDefined = false;
  }
  bool serialize(void* data, rtps::SerializedPayload_t* payload) override {
    const Bytes& bytes = *static_cast<Bytes*>(data);
    if (bytes.size() > payload->max_size) return false;
    std::memcpy(payload->data, bytes.data(), bytes.size());
    payload->length = static_cast<std::uint32_t>(bytes.size());
    payload->encapsulation = bytes[1] == 1 ? CDR_LE : CDR_BE;
    return true;
  }
  bool deserialize(rtps::SerializedPayload_t* payload, void* data) override {
    static_cast<Bytes*>(data)->assign(payload->data, payload->data + payload->length);
    return true;
  }
  std::function<std::uint32_t()> getSerializedSizeProvider(void* data) override {
    return [data] { return static_cast<std::uint32_t>(static_cast<Bytes*>(data)->size()); };
  }
  void* createData() override { return new Bytes(); }
  void deleteData(void* data) override { delete static_cast<Bytes*>(data); }
  bool getKey(void*, rtps::InstanceHandle_t*, bool) override { return false; }
};

/// On this machine alone, without multicast.
fast::DomainParticipant* participant(std::uint32_t domain) {
  fast::DomainParticipantQos qos;
  auto udp = std::make_shared<eprosima::fastdds::rtps::UDPv4TransportDescriptor>();
  udp->interfaceWhiteList = {"127.0.0.1"};
  udp->sendBufferSize = udp->receiveBufferSize = 4 << 20;
  qos.transport().use_builtin_transports = false;
  qos.transport().user_transports.push_back(udp);
  rtps::Locator_t here;
  here.kind = LOCATOR_KIND_UDPv4;
  here.address[12] = 127;
  here.address[15] = 1;
  here.port = 0;
  auto& builtin = qos.wire_protocol().builtin;
  builtin.metatrafficUnicastLocatorList.push_back(here);
  builtin.initialPeersList.push_back(here);
  return fast::DomainParticipantFactory::get_instance()->create_participant(domain, qos);
}

fast::Topic* topic(fast::DomainParticipant* node, const std::string& name,
                   const std::string& type) {
  fast::TypeSupport(new BytesType(type)).register_type(node);
  return node->create_topic(name, type, fast::TOPIC_QOS_DEFAULT);
}

template <class Qos>
Qos quality(bool transient, bool reliable = true) {
  Qos qos;
  qos.reliability().kind =
      reliable ? fast::RELIABLE_RELIABILITY_QOS : fast::BEST_EFFORT_RELIABILITY_QOS;
  qos.durability().kind =
      transient ? fast::TRANSIENT_LOCAL_DURABILITY_QOS : fast::VOLATILE_DURABILITY_QOS;
  qos.history().kind = fast::KEEP_LAST_HISTORY_QOS;
  qos.history().depth = 100;
  qos.endpoint().history_memory_policy = rtps::DYNAMIC_RESERVE_MEMORY_MODE;
  return qos;
}

using Receiver = std::function<void(const Bytes&, const fast::SampleInfo&)>;

class Listener : public fast::DataReaderListener {
 public:
  explicit Listener(Receiver receiver) : receiver_(std::move(receiver)) {}
  void on_subscription_matched(fast::DataReader*,
                               const fast::SubscriptionMatchedStatus& status) override {
    if (status.current_count_change <= 0) return;
    std::puts("matched");
    std::fflush(stdout);
  }
  void on_data_available(fast::DataReader* reader) override {
    Bytes bytes;
    fast::SampleInfo info;
    while (reader->take_next_sample(&bytes, &info) == ReturnCode_t::RETCODE_OK) {
      if (info.valid_data) receiver_(bytes, info);
    }
  }

 private:
  Receiver receiver_;
};

void listen(fast::DomainParticipant* node, fast::Topic* on, bool transient, Receiver receiver) {
  fast::Subscriber* subscriber = node->create_subscriber(fast::SUBSCRIBER_QOS_DEFAULT);
  // Lives as long as the program.
  subscriber->create_datareader(on, quality<fast::DataReaderQos>(transient),
                                new Listener(std::move(receiver)));
}

fast::DataWriter* writer_of(fast::DomainParticipant* node, fast::Topic* on, bool transient,
                            bool reliable = true) {
  auto qos = quality<fast::DataWriterQos>(transient, reliable);
  qos.publish_mode().kind = fast::ASYNCHRONOUS_PUBLISH_MODE;  // large samples are sent in fragments
  return node->create_publisher(fast::PUBLISHER_QOS_DEFAULT)->create_datawriter(on, qos);
}

void wait_for_subscriber(fast::DataWriter* writer) {
  fast::PublicationMatchedStatus status;
  while (writer->get_publication_matched_status(status), status.current_count == 0) {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
}

/// Subscribes once somebody listens behind the relay, so that nothing is lost there.
std::thread relay(fast::DomainParticipant* from, fast::DomainParticipant* to,
                  const std::string& name, const std::string& type, bool transient) {
  fast::DataWriter* writer = writer_of(to, topic(to, name, type), transient);
  const auto pass_on = [writer](const Bytes& bytes, const fast::SampleInfo& info) {
    Bytes copy = bytes;
    const std::int64_t sent = info.source_timestamp.to_ns();
    const eprosima::fastrtps::Time_t time(static_cast<std::int32_t>(sent / 1'000'000'000),
                                          static_cast<std::uint32_t>(sent % 1'000'000'000));
    const auto code = writer->write_w_timestamp(&copy, rtps::c_InstanceHandle_Unknown, time);
    if (code != ReturnCode_t::RETCODE_OK) std::cerr << "not passed on\n";
  };
  return std::thread([=] {
    wait_for_subscriber(writer);
    listen(from, topic(from, name, type), transient, pass_on);
  });
}

/// The fields in the order of nav_msgs/msg/Odometry.
void print_odometry(const Bytes& bytes) {
  Bytes copy = bytes;
  eprosima::fastcdr::FastBuffer buffer(reinterpret_cast<char*>(copy.data()), copy.size());
  eprosima::fastcdr::Cdr cdr(buffer, eprosima::fastcdr::Cdr::DEFAULT_ENDIAN,
                             eprosima::fastcdr::Cdr::DDS_CDR);
  cdr.read_encapsulation();
  std::int32_t seconds = 0;
  std::uint32_t nanoseconds = 0;
  std::string frame, child;
  std::array<double, 7> pose{};
  std::array<double, 36> pose_covariance{}, twist_covariance{};
  std::array<double, 6> twist{};
  cdr >> seconds >> nanoseconds >> frame >> child >> pose >> pose_covariance >> twist >>
      twist_covariance;
  std::printf("%d.%09u %s %s", seconds, nanoseconds, frame.c_str(), child.c_str());
  for (const double each : pose) std::printf(" %.17g", each);
  std::printf(" %.9g %.9g %.9g %.9g\n", pose_covariance[0], pose_covariance[35], twist[0],
              twist_covariance[0]);
  std::fflush(stdout);
}

/// A cloud of returns around the sensor: x, y, z (float32) in 32 bytes, as drivers pad them.
Bytes cloud(std::uint32_t returns, std::int64_t stamp) {
  constexpr std::uint32_t kStep = 32;
  constexpr float kTurn = 6.2831853F;
  constexpr std::uint8_t kFloat = 7;
  std::vector<std::uint8_t> data(std::size_t{returns} * kStep);
  for (std::uint32_t i = 0; i < returns; ++i) {
    const float angle = kTurn * static_cast<float>(i) / static_cast<float>(returns);
    const float range = 5.0F + 1e-10F * static_cast<float>(stamp % 10'000'000'000);
    const std::array<float, 3> p = {range * std::cos(angle), range * std::sin(angle), 0.5F};
    std::memcpy(data.data() + std::size_t{i} * kStep, p.data(), sizeof(p));
  }
  eprosima::fastcdr::FastBuffer buffer;
  eprosima::fastcdr::Cdr cdr(buffer, eprosima::fastcdr::Cdr::DEFAULT_ENDIAN,
                             eprosima::fastcdr::Cdr::DDS_CDR);
  cdr.serialize_encapsulation();
  cdr << static_cast<std::int32_t>(stamp / 1'000'000'000)
      << static_cast<std::uint32_t>(stamp % 1'000'000'000) << std::string("lidar");
  cdr << std::uint32_t{1} << returns << std::uint32_t{3};
  for (std::uint32_t i = 0; i < 3; ++i) {
    cdr << std::string(1, static_cast<char>('x' + i)) << 4 * i << kFloat << std::uint32_t{1};
  }
  cdr << false << kStep << kStep * returns << data << true;
  const auto* begin = reinterpret_cast<const rtps::octet*>(buffer.getBuffer());
  return {begin, begin + cdr.getSerializedDataLength()};
}

void send_clouds(fast::DomainParticipant* node, const std::string& name, int count,
                 std::uint32_t returns, bool reliable) {
  fast::DataWriter* writer =
      writer_of(node, topic(node, name, "sensor_msgs::msg::dds_::PointCloud2_"), false, reliable);
  wait_for_subscriber(writer);
  // It may find this publisher later than it is found.
  std::this_thread::sleep_for(std::chrono::seconds(1));
  constexpr int kSmall = 5;
  int sent = 0;  // those are refused that exceed what writer and type declare
  for (int i = 0; i < count + kSmall; ++i) {
    Bytes bytes = cloud(i < count ? returns : 100, (1000 + i) * std::int64_t{100'000'000});
    sent += writer->write(&bytes) ? 1 : 0;
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
  writer->wait_for_acknowledgments(eprosima::fastrtps::Duration_t(60, 0));
  std::printf("sent %d\n", sent);
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  const std::vector<std::string> arguments(argv + 1, argv + argc);
  std::vector<fast::DomainParticipant*> participants;  // those who receive first
  if (arguments.size() >= 6 && arguments[0] == "relay") {
    auto* from = participant(static_cast<std::uint32_t>(std::stoul(arguments[1])));
    auto* to = participant(static_cast<std::uint32_t>(std::stoul(arguments[2])));
    participants = {from, to};
    for (std::size_t i = 3; i + 2 < arguments.size(); i += 3) {
      relay(from, to, arguments[i], arguments[i + 1], arguments[i + 2] == "transient").detach();
    }
  } else if (arguments.size() == 3 && arguments[0] == "odometry") {
    auto* node = participant(static_cast<std::uint32_t>(std::stoul(arguments[1])));
    listen(node, topic(node, arguments[2], "nav_msgs::msg::dds_::Odometry_"), false,
           [](const Bytes& bytes, const fast::SampleInfo&) { print_odometry(bytes); });
  } else if (arguments.size() == 6 && arguments[0] == "clouds") {
    send_clouds(participant(static_cast<std::uint32_t>(std::stoul(arguments[1]))), arguments[2],
                std::stoi(arguments[3]), static_cast<std::uint32_t>(std::stoul(arguments[4])),
                arguments[5] == "reliable");
  } else {
    std::cerr << "usage: see the head of fastdds_peer.cpp\n";
    return 2;
  }
  while (std::cin.get() != EOF) {
  }
  // Who receives from it sees that it goes; nothing that threads of listeners use is destroyed.
  for (auto* each : participants) each->delete_contained_entities();
  std::_Exit(0);
}
