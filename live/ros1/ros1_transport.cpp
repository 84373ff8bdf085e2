// SPDX-License-Identifier: BSD-3-Clause
#include "live/ros1/ros1_transport.hpp"

#include <ros/callback_queue.h>
#include <ros/ros.h>
#include <signal.h>
#include <topic_tools/shape_shifter.h>

#include <algorithm>
#include <iterator>
#include <tuple>
#include <utility>

#include "live/inbox.hpp"

namespace aims {
namespace {

using topic_tools::ShapeShifter;

/// Length of roscpp's queue: five seconds at 200 Hz.
constexpr std::uint32_t kQueueSize = 1000;
/// Period in which a waiting node checks whether it was asked to end [s].
constexpr double kMaxWait = 0.1;

/// Output of ShapeShifter and roscpp's serialization.
struct ByteStream {
  std::vector<std::byte>& bytes;
  std::uint8_t* advance(std::uint32_t size) {
    bytes.resize(size);
    return reinterpret_cast<std::uint8_t*>(bytes.data());
  }
};

void request_end(int) { ros::requestShutdown(); }

}  // namespace

struct Ros1Transport::Impl {
  using Event = ros::MessageEvent<const ShapeShifter>;
  using Key = std::tuple<std::string, std::string, bool>;  // topic, md5, latching

  ros::NodeHandle node;
  ros::CallbackQueue queue;
  std::map<std::string, ros::Subscriber> subscribers;
  std::map<Key, std::shared_ptr<const LiveConnection>> connections;
  std::vector<std::pair<ros::Publisher, LiveConnection>> publishers;
  Inbox inbox;

  void take(const std::string& topic, const Event& event) {
    const ShapeShifter& message = *event.getConstMessage();
    const auto& header = event.getConnectionHeaderPtr();
    const auto latching = header->find("latching");
    const bool latched = latching != header->end() && latching->second == "1";
    auto& connection = connections[{topic, message.getMD5Sum(), latched}];
    if (!connection) {
      connection = std::make_shared<LiveConnection>(
          LiveConnection{topic, message.getDataType(), message.getMD5Sum(),
                         message.getMessageDefinition(), latched, false});
    }
    LiveMessage taken;
    taken.connection = connection;
    taken.arrival = static_cast<std::int64_t>(event.getReceiptTime().toNSec());
    ByteStream stream{taken.data};
    message.write(stream);
    inbox.push(std::move(taken));
  }
};

Ros1Transport::Ros1Transport(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Ros1Transport::~Ros1Transport() = default;

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

std::unique_ptr<Ros1Transport> Ros1Transport::connect(int argc, char** argv,
                                                      const std::string& name, std::string& error) {
  try {
    ros::init(argc, argv, name, ros::init_options::NoRosout);
  } catch (const std::exception& exception) {
    error = exception.what();
    return nullptr;
  }
  if (!ros::master::check()) {
    error = "no ROS master at " + ros::master::getURI() + "; start one, or set ROS_MASTER_URI";
    return nullptr;
  }
  auto impl = std::make_unique<Impl>();
  signal(SIGTERM, request_end);
  // A lost ssh connection; under nohup it stays ignored.
  if (signal(SIGHUP, request_end) == SIG_IGN) signal(SIGHUP, SIG_IGN);
  return std::unique_ptr<Ros1Transport>(new Ros1Transport(std::move(impl)));
}

bool Ros1Transport::running() const { return ros::ok(); }

std::map<std::string, std::string> Ros1Transport::topics() {
  ros::master::V_TopicInfo found;
  std::map<std::string, std::string> types;
  if (!ros::master::getTopics(found)) return types;
  const std::string own = resolved("~");
  for (const ros::master::TopicInfo& topic : found) {
    if (topic.name.rfind(own, 0) != 0) types[topic.name] = topic.datatype;
  }
  return types;
}

std::string Ros1Transport::resolved(const std::string& topic) const {
  return ros::names::resolve(topic);
}

void Ros1Transport::subscribe(const std::string& topic, const std::string& /*type*/) {
  const std::string name = resolved(topic);
  if (impl_->subscribers.count(name) > 0) return;
  ros::SubscribeOptions options;
  options.initByFullCallbackType<const Impl::Event&>(
      name, kQueueSize,
      [impl = impl_.get(), name](const Impl::Event& event) { impl->take(name, event); });
  options.callback_queue = &impl_->queue;
  options.transport_hints = ros::TransportHints().tcpNoDelay();
  impl_->subscribers[name] = impl_->node.subscribe(options);
}

void Ros1Transport::unsubscribe(const std::string& topic) {
  impl_->subscribers.erase(resolved(topic));
}

std::optional<LiveMessage> Ros1Transport::wait(double seconds) {
  const ros::WallTime end = ros::WallTime::now() + ros::WallDuration(seconds);
  impl_->queue.callAvailable();
  while (impl_->inbox.empty()) {
    const double left = (end - ros::WallTime::now()).toSec();
    if (left <= 0.0 || !ros::ok()) return std::nullopt;
    impl_->queue.callAvailable(ros::WallDuration(std::min(left, kMaxWait)));
  }
  return impl_->inbox.pop();
}

std::size_t Ros1Transport::dropped() const { return impl_->inbox.dropped(); }

void Ros1Transport::limit_wait(std::int64_t longest) { impl_->inbox.limit_wait(longest); }

std::size_t Ros1Transport::advertise(const LiveConnection& connection) {
  ros::AdvertiseOptions options(resolved(connection.topic), 100, connection.md5, connection.type,
                                connection.definition);
  options.latch = connection.latching;
  impl_->publishers.emplace_back(impl_->node.advertise(options), connection);
  return impl_->publishers.size() - 1;
}

bool Ros1Transport::heard(std::size_t publisher) const {
  return impl_->publishers.at(publisher).first.getNumSubscribers() > 0;
}

void Ros1Transport::publish(std::size_t publisher, const std::byte* data, std::size_t size) {
  const auto& [target, connection] = impl_->publishers.at(publisher);
  ShapeShifter message;
  message.morph(connection.md5, connection.type, connection.definition,
                connection.latching ? "1" : "0");
  // Only read: roscpp has one stream type for both directions.
  auto* bytes = const_cast<std::uint8_t*>(reinterpret_cast<const std::uint8_t*>(data));
  ros::serialization::IStream stream(bytes, static_cast<std::uint32_t>(size));
  message.read(stream);
  target.publish(message);
}

}  // namespace aims
