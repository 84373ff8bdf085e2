// SPDX-License-Identifier: BSD-3-Clause
#include "live/ros1/ros1_transport.hpp"

#include <ros/callback_queue.h>
#include <ros/ros.h>
#include <topic_tools/shape_shifter.h>

#include <algorithm>
#include <iterator>
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

}  // namespace

struct Ros1Transport::Impl {
  using Event = ros::MessageEvent<const ShapeShifter>;
  using Key = std::tuple<std::string, std::string, bool>;  // topic, md5, latching

  ros::NodeHandle node;
  ros::CallbackQueue queue;
  std::map<std::string, ros::Subscriber> subscribers;
  std::map<Key, std::shared_ptr<const BagConnection>> connections;
  std::vector<std::pair<ros::Publisher, ShapeShifter>> publishers;
  ros::AsyncSpinner spinner{1, &queue};  ///< its thread takes messages over

  LiveMessage taken(const std::string& topic, const Event& event) {
    const ShapeShifter& message = *event.getConstMessage();
    const auto& header = event.getConnectionHeaderPtr();
    const auto latching = header->find("latching");
    const bool latched = latching != header->end() && latching->second == "1";
    auto& connection = connections[{topic, message.getMD5Sum(), latched}];
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
};

Ros1Transport::Ros1Transport(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}

Ros1Transport::~Ros1Transport() { impl_->spinner.stop(); }

std::vector<std::string> Ros1Transport::own_arguments(int argc, char** argv) {
  std::vector<std::string> arguments;
  ros::removeROSArgs(argc, argv, arguments);
  if (!arguments.empty()) arguments.erase(arguments.begin());
  // Private parameters ("_name:=value") are not read: they are refused as unknown, not ignored.
  std::copy_if(argv + 1, argv + argc, std::back_inserter(arguments), [](const std::string& each) {
    return each.size() > 1 && each[0] == '_' && each[1] != '_';
  });
  return arguments;
}

Result<std::unique_ptr<Ros1Transport>> Ros1Transport::connect(int argc, char** argv,
                                                              const std::string& name) {
  try {
    ros::init(argc, argv, name, ros::init_options::NoRosout | ros::init_options::NoSigintHandler);
  } catch (const std::exception& exception) {
    return failure(exception.what());
  }
  if (!ros::master::check()) {
    return failure("no ROS master at " + ros::master::getURI() +
                   "; start one, or set ROS_MASTER_URI");
  }
  auto impl = std::make_unique<Impl>();
  impl->spinner.start();
  return std::unique_ptr<Ros1Transport>(new Ros1Transport(std::move(impl)));
}

bool Ros1Transport::running() const { return Transport::running() && ros::ok(); }

std::map<std::string, std::string> Ros1Transport::topics() {
  ros::master::V_TopicInfo found;
  std::map<std::string, std::string> types;
  if (!ros::master::getTopics(found)) return types;
  const std::string own = resolved("~");
  for (const ros::master::TopicInfo& topic : found) {
    if (!topic.name.starts_with(own)) types[topic.name] = topic.datatype;
  }
  return types;
}

std::string Ros1Transport::resolved(const std::string& topic) const {
  return ros::names::resolve(topic);
}

void Ros1Transport::subscribe(const std::string& topic, const std::string& /*type*/) {
  const std::string name = resolved(topic);
  if (impl_->subscribers.contains(name)) return;
  ros::SubscribeOptions options;
  options.initByFullCallbackType<const Impl::Event&>(
      name, kQueueSize,
      [this, name](const Impl::Event& event) { inbox_.push(impl_->taken(name, event)); });
  options.callback_queue = &impl_->queue;
  options.transport_hints = ros::TransportHints().tcpNoDelay();
  impl_->subscribers[name] = impl_->node.subscribe(options);
}

void Ros1Transport::unsubscribe(const std::string& topic) {
  impl_->subscribers.erase(resolved(topic));
}

std::size_t Ros1Transport::advertise(const std::string& topic, const MessageType& type,
                                     bool latching) {
  ros::AdvertiseOptions options(resolved(topic), kSendQueue, type.md5, type.name, type.definition);
  options.latch = latching;
  ShapeShifter message;
  message.morph(type.md5, type.name, type.definition, latching ? "1" : "0");
  impl_->publishers.emplace_back(impl_->node.advertise(options), message);
  return impl_->publishers.size() - 1;
}

bool Ros1Transport::heard(std::size_t publisher) const {
  return impl_->publishers.at(publisher).first.getNumSubscribers() > 0;
}

void Ros1Transport::publish(std::size_t publisher, std::span<const std::byte> data) {
  auto& [target, message] = impl_->publishers.at(publisher);
  // Only read: roscpp has one stream type for both directions.
  auto* bytes = const_cast<std::uint8_t*>(reinterpret_cast<const std::uint8_t*>(data.data()));
  ros::serialization::IStream stream(bytes, static_cast<std::uint32_t>(data.size()));
  message.read(stream);
  target.publish(message);
}

}  // namespace aims
