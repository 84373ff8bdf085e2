// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <cstdlib>
#include <vector>

#include "io/bag/bag_output.hpp"
#include "io/bag/bag_publisher.hpp"
#include "io/bag/bag_writer.hpp"
#include "io/byte_cursor.hpp"
#include "io/ros/message_types.hpp"
#include "tests/fuzz/fuzz_targets.hpp"
#include "tests/fuzz/memory_file.hpp"
#include "tests/fuzz/touch.hpp"

namespace aims {
namespace {

/// A bag in memory.
class MemoryOutput final : public BagOutput {
 public:
  explicit MemoryOutput(std::vector<std::byte>& bytes) : bytes_(bytes) {
    bytes_ = BagPublisher::empty_bag();
  }
  Result<void> write_at(std::uint64_t offset, std::span<const std::byte> bytes) override {
    if (bytes_.size() < offset + bytes.size()) bytes_.resize(offset + bytes.size());
    std::copy(bytes.begin(), bytes.end(), bytes_.begin() + static_cast<std::ptrdiff_t>(offset));
    return {};
  }
  Result<void> truncate(std::uint64_t size) override {
    bytes_.resize(size);
    return {};
  }
  Result<void> close() override { return {}; }

 private:
  std::vector<std::byte>& bytes_;
};

void demand(const Result<void>& outcome) {
  if (!outcome) std::abort();
}

}  // namespace

void fuzz_recording(std::span<const std::uint8_t> input) {
  std::vector<std::byte> bytes;
  {
    auto bag = BagWriter::create(std::make_unique<MemoryOutput>(bytes), "fuzz.bag",
                                 {BagCompression::kNone, 1 << 14});
    const std::array<MessageType, 6> types = {imu_type(),           point_cloud_type(),
                                              odometry_type(),      joint_state_type(),
                                              foot_contacts_type(), transforms_type()};
    for (const MessageType& type : types) bag->add_connection("/" + type.name, type);
    // Each message: topic, time since the last [ms], length, bytes.
    ByteCursor cursor(std::as_bytes(input));
    Time time = kSecond;
    while (cursor.left() >= 4) {
      const auto topic = *cursor.number<std::uint8_t>() % types.size();
      time += *cursor.number<std::uint8_t>() * kMillisecond;
      const std::size_t size = *cursor.number<std::uint16_t>();
      const auto data = cursor.take(std::min(size, cursor.left()));
      demand(bag->write(static_cast<std::uint32_t>(topic), time, *data));
    }
    demand(bag->close());
  }
  const MemoryFile file(bytes);
  touch_recording(file.path(), false);
}

}  // namespace aims
