// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/messages/cdr_transcoder.hpp"

#include <fmt/format.h>

#include <limits>
#include <utility>

#include "core/files/byte_cursor.hpp"
#include "recordings/messages/message_definition.hpp"
#include "recordings/messages/message_traversal.hpp"
#include "recordings/messages/ros2_definition.hpp"

namespace aims {
namespace {

constexpr std::size_t kTimeSize = 8;
constexpr auto kNone = std::numeric_limits<std::size_t>::max();

/// Walks one message of ROS 1, whose lengths were checked, and writes its values as CDR.
class Walk {
 public:
  Walk(const std::vector<MessageLayout>& layouts, std::span<const std::byte> data,
       MessageBytes& out)
      : layouts_(layouts), data_(data), out_(out), traversal_(layouts, data, std::endian::little) {}

  /// Writes the message at `start`; returns its end, or `kNone` for a time out of range.
  std::size_t message(const MessageLayout& layout, std::size_t start) {
    for (const FieldSlot& slot : layout.slots) {
      // Without padding each field begins where the last one ends.
      const std::size_t end = field(slot, start);
      if (end == kNone) return kNone;
      start = end;
    }
    return start;
  }

 private:
  std::size_t field(const FieldSlot& slot, std::size_t start) {
    if (slot.is_placeholder) {
      out_.put(std::uint8_t{0});
      return start;
    }
    const std::uint32_t count = traversal_.count_of(slot, start).value_or(0);
    if (slot.counted) out_.length(count);
    if (slot.kind == FieldKind::kNumber || slot.kind == FieldKind::kNumbers) {
      return numbers(slot, start, count);
    }
    for (std::uint32_t i = 0; i < count && start != kNone; ++i) {
      if (slot.kind == FieldKind::kMessages) {
        start = message(layouts_[slot.element], start);
      } else if (slot.kind == FieldKind::kTime || slot.kind == FieldKind::kTimes) {
        start = time(slot, start);
      } else {
        const TextPlace text = traversal_.text_at(slot, start).value_or(TextPlace{});
        out_.text(as_text(data_.subspan(text.start, text.size)));
        start = text.end;
      }
    }
    return start;
  }

  std::size_t numbers(const FieldSlot& slot, std::size_t start, std::uint32_t count) {
    const std::size_t size = std::size_t{slot.entry_size} * count;
    if (slot.is_sequence_number || count == 0) return start + size;
    out_.align(slot.entry_size);
    out_.append(data_.data() + start, size);
    return start + size;
  }

  std::size_t time(const FieldSlot& slot, std::size_t start) {
    const auto seconds = load_number<std::uint32_t>(data_.data() + start);
    const auto nanoseconds = load_number<std::uint32_t>(data_.data() + start + 4);
    constexpr std::uint32_t kSign = 0x80000000;
    // Seconds become signed; a duration's nanoseconds lose their sign.
    const bool is_duration = slot.number == NumberType::kInt32;
    if (((is_duration ? nanoseconds : seconds) & kSign) != 0) return kNone;
    out_.put(seconds);
    out_.put(nanoseconds);
    return start + kTimeSize;
  }

  const std::vector<MessageLayout>& layouts_;
  std::span<const std::byte> data_;
  MessageBytes& out_;
  MessageTraversal traversal_;
};

}  // namespace

Result<CdrTranscoder> CdrTranscoder::create(const MessageType& ros1) {
  auto type = ros2_type(ros1);
  if (!type) return tl::unexpected(type.error());
  auto layouts = message_layouts(ros1.name, ros1.definition, ros1.format);
  if (!layouts) return tl::unexpected(layouts.error());
  return CdrTranscoder(std::move(*type), std::move(*layouts));
}

Result<MessageBytes> CdrTranscoder::transcode(std::span<const std::byte> data) const {
  const MessageLayout& layout = layouts_.back();
  const auto end = MessageTraversal(layouts_, data, std::endian::little).end_of(layout, 0);
  if (!end || *end != data.size()) {
    return failure(fmt::format("{}: expected a message as its definition states, found {} bytes",
                               layout.type, data.size()));
  }
  MessageBytes out(Serialization::kCdr);
  out.reserve(data.size() + data.size() / 8 + 64);
  if (Walk(layouts_, data, out).message(layout, 0) == kNone) {
    return failure(
        fmt::format("{}: a time that ROS 2 cannot hold: from 2038 on, or a duration "
                    "with negative nanoseconds",
                    layout.type));
  }
  return out;
}

}  // namespace aims
