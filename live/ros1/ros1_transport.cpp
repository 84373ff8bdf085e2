// SPDX-License-Identifier: BSD-3-Clause
#include "live/ros1/ros1_transport.hpp"

#include <ros/callback_queue.h>
#include <ros/ros.h>
#include <topic_tools/shape_shifter.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <tuple>
#include <utility>

namespace aims {
namespace {

using topic_tools::ShapeShifter;

constexpr std::uint32_t kQueueSize = 1000;  ///< of roscpp: five seconds at 200 Hz
constexpr std::uint32_t kSendQueue = 100;

/// Output of ShapeShifter.
struct ByteStream {
  std::vector<std::byte>& bytes;
  std::uint8_t* advance(std::uint32_t size) {
    bytes.resize(size);
    return reinterpret_cast<std::uint8_t*>(bytes.data());
  }
};

class Ros1Transport final : public Transport {
 public:
  Ros1Transport() { spinner_.start(); }
  ~Ros1Transport() override { spinner_.stop(); }

  MessageFormat format() const override { return kRos1Format; }
  bool running() const override { return Transport::running() && ros::ok(); }

  std::map<std::string, std::string> topics() override {
    ros::master::V_TopicInfo found;
    std::map<std::string, std::string> types;
    if (!ros::master::getTopics(found)) return types;
    const std::string own = resolved("~");
    for (const ros::master::TopicInfo& topic : found) {
      if (!topic.name.starts_with(own)) types[topic.name] = topic.datatype;
    }
    return types;
  }

  std::string resolved(const std::string& topic) const override {
    return ros::names::resolve(topic);
  }

  void subscribe(const std::string& topic, const std::string& /*type*/) override {
    const std::string name = resolved(topic);
    if (subscribers_.contains(name)) return;
    ros::SubscribeOptions options;
    options.initByFullCallbackType<const Event&>(
        name, kQueueSize, [this, name](const Event& event) { inbox_.push(taken(name, event)); });
    options.callback_queue = &queue_;
    options.transport_hints = ros::TransportHints().tcpNoDelay();
    subscribers_[name] = node_.subscribe(options);
  }

  void unsubscribe(const std::string& topic) override { subscribers_.erase(resolved(topic)); }

  std::size_t advertise(const std::string& topic, const MessageType& type, bool latching) override {
    ros::AdvertiseOptions options(resolved(topic), kSendQueue, type.md5, type.name,
                                  type.definition);
    options.latch = latching;
    ShapeShifter message;
    message.morph(type.md5, type.name, type.definition, latching ? "1" : "0");
    publishers_.emplace_back(node_.advertise(options), message);
    return publishers_.size() - 1;
  }

  bool heard(std::size_t publisher) const override {
    return publishers_.at(publisher).first.getNumSubscribers() > 0;
  }

  void publish(std::size_t publisher, std::span<const std::byte> data) override {
    auto& [target, message] = publishers_.at(publisher);
    // Only read: roscpp has one stream type for both directions.
    auto* bytes = const_cast<std::uint8_t*>(reinterpret_cast<const std::uint8_t*>(data.data()));
    ros::serialization::IStream stream(bytes, static_cast<std::uint32_t>(data.size()));
    message.read(stream);
    target.publish(message);
  }

 private:
  using Event = ros::MessageEvent<const ShapeShifter>;
  using Key = std::tuple<std::string, std::string, bool>;  // topic, md5, latching

  LiveMessage taken(const std::string& topic, const Event& event) {
    const ShapeShifter& message = *event.getConstMessage();
    const auto& header = event.getConnectionHeaderPtr();
    const auto latching = header->find("latching");
    const bool latched = latching != header->end() && latching->second == "1";
    auto& connection = connections_[{topic, message.getMD5Sum(), latched}];
    if (!connection) {
      BagConnection made;
      made.topic = topic;
      made.type = message.getDataType();
      made.md5 = message.getMD5Sum();
      made.definition = message.getMessageDefinition();
      made.latching = latched;
      connection = std::make_shared<BagConnection>(std::move(made));
    }
    LiveMessage taken{connection, static_cast<Time>(event.getReceiptTime().toNSec()), {}};
    ByteStream stream{taken.data};
    message.write(stream);
    return taken;
  }

  ros::NodeHandle node_;
  ros::CallbackQueue queue_;
  std::map<std::string, ros::Subscriber> subscribers_;
  std::map<Key, std::shared_ptr<const BagConnection>> connections_;
  std::vector<std::pair<ros::Publisher, ShapeShifter>> publishers_;
  ros::AsyncSpinner spinner_{1, &queue_};  ///< its thread takes messages over
};

}  // namespace

std::vector<std::string> arguments_without_ros(int argc, char** argv) {
  std::vector<std::string> arguments;
  ros::removeROSArgs(argc, argv, arguments);
  if (!arguments.empty()) arguments.erase(arguments.begin());
  // Private parameters ("_name:=value") are not read: they are refused as unknown, not ignored.
  std::copy_if(argv + 1, argv + argc, std::back_inserter(arguments), [](const std::string& each) {
    return each.size() > 1 && each[0] == '_' && each[1] != '_';
  });
  return arguments;
}

Result<std::unique_ptr<Transport>> connect_to_ros1(int argc, char** argv, const std::string& name) {
  try {
    ros::init(argc, argv, name, ros::init_options::NoRosout | ros::init_options::NoSigintHandler);
  } catch (const std::exception& exception) {
    return failure(exception.what());
  }
  if (!ros::master::check()) {
    return failure("no ROS master at " + ros::master::getURI() +
                   "; start one, or set ROS_MASTER_URI");
  }
  return std::make_unique<Ros1Transport>();
}

}  // namespace aims
