// SPDX-License-Identifier: BSD-3-Clause
// The same listing as bag_tool's, made by librosbag-storage (C++17: its headers need that), and a
// writer to be killed:
//   rosbag_storage_tool list FILE
//   rosbag_storage_tool flood FILE
#include <rosbag/bag.h>
#include <rosbag/view.h>

#include <boost/crc.hpp>
#include <cstdio>
#include <string>
#include <vector>

namespace {

int list(const std::string& file) {
  rosbag::Bag bag(file, rosbag::bagmode::Read);
  rosbag::View view(bag);
  for (const rosbag::MessageInstance& message : view) {
    std::vector<std::uint8_t> bytes(message.size());
    ros::serialization::OStream stream(bytes.data(), static_cast<std::uint32_t>(bytes.size()));
    message.write(stream);
    boost::crc_32_type crc;
    crc.process_bytes(bytes.data(), bytes.size());
    std::printf(
        "%llu %s %s %zu %08x\n", static_cast<unsigned long long>(message.getTime().toNSec()),
        message.getTopic().c_str(), message.getDataType().c_str(), bytes.size(), crc.checksum());
  }
  return 0;
}

/// A std_msgs/String, written out so that no package of messages is needed.
struct Text {
  std::string data;
};

}  // namespace

namespace ros {
namespace message_traits {
template <>
struct MD5Sum<Text> {
  static const char* value() { return "992ce8a1687cec8c8bd883ec73ca41d1"; }
  static const char* value(const Text&) { return value(); }
};
template <>
struct DataType<Text> {
  static const char* value() { return "std_msgs/String"; }
  static const char* value(const Text&) { return value(); }
};
template <>
struct Definition<Text> {
  static const char* value() { return "string data\n"; }
  static const char* value(const Text&) { return value(); }
};
}  // namespace message_traits
namespace serialization {
template <>
struct Serializer<Text> {
  template <class Stream, class Message>
  static void allInOne(Stream& stream, Message message) {
    stream.next(message.data);
  }
  ROS_DECLARE_ALLINONE_SERIALIZER
};
}  // namespace serialization
}  // namespace ros

namespace {

int flood(const std::string& file) {
  rosbag::Bag bag(file, rosbag::bagmode::Write);
  bag.setChunkThreshold(100000);
  for (std::uint32_t i = 0; i < 10'000'000; ++i) {
    bag.write("/flood", ros::Time(1000 + i / 1000, i % 1000 * 1000000),
              Text{std::string(1000, 'x')});
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  const std::vector<std::string> words(argv + 1, argv + argc);
  try {
    if (words.size() == 2 && words[0] == "list") return list(words[1]);
    if (words.size() == 2 && words[0] == "flood") return flood(words[1]);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
  }
  std::fprintf(stderr, "usage: rosbag_storage_tool list|flood FILE\n");
  return 2;
}
