// SPDX-License-Identifier: BSD-3-Clause
#include <array>
#include <memory>
#include <string>
#include <vector>

#include "core/files/byte_cursor.hpp"
#include "recordings/messages/message_encoding.hpp"
#include "recordings/messages/message_types.hpp"
#include "recordings/source/recording_file.hpp"
#include "tests/fuzz/fuzz_targets.hpp"
#include "tests/fuzz/memory_bag.hpp"
#include "tests/fuzz/memory_file.hpp"
#include "tests/fuzz/touch.hpp"

namespace aims {
namespace {

constexpr std::size_t kFiles = 3;

/// Messages in order of time; how many there are.
std::size_t read_in_order(MessageSource& source) {
  std::size_t count = 0;
  Time last = 0;
  while (true) {
    const auto message = source.next();
    demand(message.has_value());
    if (!*message) return count;
    demand((*message)->record_time >= last);
    last = (*message)->record_time;
    ++count;
  }
}

}  // namespace

void fuzz_merged(std::span<const std::uint8_t> input) {
  std::array<MemoryBag, kFiles> bags;
  for (MemoryBag& bag : bags) {
    bag.add("/a", string_type());
    bag.add("/b", string_type());
  }
  // Each message: file and topic, time since the last, content. What two files hold counts once.
  ByteCursor cursor(std::as_bytes(input));
  Time time = kSecond;
  std::size_t written = 0;
  while (cursor.left() >= 3) {
    const auto place = *cursor.number<std::uint8_t>();
    time += *cursor.number<std::uint8_t>();
    MessageBytes message;
    message.text(std::string(*cursor.number<std::uint8_t>() % 8U, 'x'));
    bags[place % kFiles].write(place / kFiles % 2U, time, message.view());
    ++written;
  }
  const MemoryFile first(bags[0].bytes()), second(bags[1].bytes()), third(bags[2].bytes());
  const auto source = open_recording(
      first.path(), {.memory_limit = std::size_t{16} << 20, .with = {second.path(), third.path()}});
  demand(source.has_value());
  const std::size_t read = read_in_order(**source);
  demand(read <= written);
  (*source)->rewind();
  demand(read_in_order(**source) == read);
  const std::array<std::string, 1> topics = {"/b"};
  (*source)->select(topics);
  (*source)->rewind();
  demand(read_in_order(**source) <= read);
}

}  // namespace aims
