// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/messages/message_traversal.hpp"

#include "core/files/byte_cursor.hpp"

namespace aims {
namespace {

constexpr std::size_t kLength = sizeof(std::uint32_t);

}  // namespace

std::nullopt_t MessageTraversal::fail(const std::string& field, std::size_t offset,
                                      std::uint64_t needed) {
  error_ = {field, offset, needed};
  return std::nullopt;
}

std::optional<std::uint32_t> MessageTraversal::count_of(const FieldSlot& slot, std::size_t& start) {
  if (!slot.counted) return slot.count;
  if (!has(start, kLength)) return fail(slot.path, start, kLength);
  const auto count = load_number<std::uint32_t>(bytes_.data() + start);
  start += kLength;
  return count;
}

std::optional<std::size_t> MessageTraversal::end_of(const FieldSlot& slot, std::size_t start) {
  if (slot.kind == FieldKind::kText || slot.kind == FieldKind::kTexts) {
    const auto count = count_of(slot, start);
    if (!count) return std::nullopt;
    for (std::uint32_t i = 0; i < *count; ++i) {
      if (!has(start, kLength)) return fail(slot.path, start, kLength);
      const auto size = load_number<std::uint32_t>(bytes_.data() + start);
      start += kLength;
      if (!has(start, size)) return fail(slot.path, start, size);
      start += size;
    }
    return start;
  }
  const auto count = count_of(slot, start);
  if (!count) return std::nullopt;
  if (slot.entry_size > 0) {
    const std::uint64_t size = std::uint64_t{slot.entry_size} * *count;
    if (!has(start, size)) return fail(slot.path, start, size);
    return start + size;
  }
  for (std::uint32_t i = 0; i < *count; ++i) {
    const auto end = end_of(layouts_[slot.element], start);
    if (!end) {
      error_.field = slot.path + "[" + std::to_string(i) + "]." + error_.field;
      return std::nullopt;
    }
    start = *end;
  }
  return start;
}

std::optional<std::size_t> MessageTraversal::end_of(const MessageLayout& layout, std::size_t start,
                                                    std::uint32_t* segments) {
  for (std::size_t i = 0; i < layout.segment_sizes.size(); ++i) {
    if (segments != nullptr) segments[i] = static_cast<std::uint32_t>(start);
    if (!has(start, layout.segment_sizes[i])) {
      for (const FieldSlot& slot : layout.slots) {
        const std::uint64_t size = std::uint64_t{slot.entry_size} * slot.count;
        if (slot.segment == i && !has(start, slot.offset + size)) {
          return fail(slot.path, start + slot.offset, size);
        }
      }
    }
    start += layout.segment_sizes[i];
    if (i == layout.variable_slots.size()) break;
    const auto end = end_of(layout.slots[layout.variable_slots[i]], start);
    if (!end) return std::nullopt;
    start = *end;
  }
  return start;
}

std::size_t MessageTraversal::start_of(const MessageLayout& layout, const FieldSlot& slot,
                                       std::size_t start) {
  for (std::uint32_t i = 0; i < slot.segment; ++i) {
    start += layout.segment_sizes[i];
    start = end_of(layout.slots[layout.variable_slots[i]], start).value_or(start);
  }
  return start + slot.offset;
}

}  // namespace aims
