// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/messages/message_traversal.hpp"

#include "core/files/byte_cursor.hpp"

namespace aims {
namespace {

constexpr std::uint32_t kLength = sizeof(std::uint32_t);

std::size_t place_of(const FieldSlot& slot, std::size_t segment) {
  return segment + slot.offset[segment % slot.offset.size()];
}

}  // namespace

std::nullopt_t MessageTraversal::fail(const std::string& field, std::size_t offset,
                                      std::uint64_t needed) {
  error_ = {field, offset, needed};
  return std::nullopt;
}

/// The length at `start`, which moves behind it.
std::optional<std::uint32_t> MessageTraversal::length_at(const FieldSlot& slot,
                                                         std::size_t& start) {
  if (cdr_) start = aligned(start, kLength);
  if (!has(start, kLength)) return fail(slot.path, start, kLength);
  const auto length = load_number<std::uint32_t>(bytes_.data() + start, order_);
  start += kLength;
  return length;
}

std::optional<TextPlace> MessageTraversal::text_at(const FieldSlot& slot, std::size_t start) {
  const auto length = length_at(slot, start);
  if (!length) return std::nullopt;
  if (!has(start, *length)) return fail(slot.path, start, *length);
  // CDR counts the zero that ends the text.
  const std::size_t size = cdr_ && *length > 0 ? *length - 1 : *length;
  return TextPlace{start, size, start + *length};
}

std::optional<std::uint32_t> MessageTraversal::count_of(const FieldSlot& slot, std::size_t& start) {
  if (!slot.counted) return slot.count;
  const auto count = length_at(slot, start);
  // Without entries nothing is aligned to them.
  if (count && *count > 0) start = aligned(start, slot.alignment);
  return count;
}

std::size_t MessageTraversal::start_of_entry(const FieldSlot& slot, std::size_t start,
                                             std::uint32_t entry) {
  if (slot.entry_size > 0) return start + std::size_t{slot.entry_size} * entry;
  for (std::uint32_t i = 0; i < entry; ++i) {
    if (slot.kind == FieldKind::kMessages) {
      start = end_of(layouts_[slot.element], start).value_or(start);
    } else if (const auto text = text_at(slot, start)) {
      start = text->end;
    }
  }
  return start;
}

std::optional<std::size_t> MessageTraversal::end_of(const FieldSlot& slot, std::size_t start) {
  const auto count = count_of(slot, start);
  if (!count) return std::nullopt;
  if (slot.kind == FieldKind::kText || slot.kind == FieldKind::kTexts) {
    for (std::uint32_t i = 0; i < *count; ++i) {
      const auto text = text_at(slot, start);
      if (!text) return std::nullopt;
      start = text->end;
    }
    return start;
  }
  if (slot.entry_size > 0) {
    const std::uint64_t size = slot.size_of_entries(*count);
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
    const BytesByPhase& sizes = layout.segment_sizes[i];
    const std::uint32_t known = sizes[start % sizes.size()];
    if (!has(start, known)) {
      for (const FieldSlot& slot : layout.slots) {
        if (slot.segment != i || slot.is_variable()) continue;
        const std::size_t place = place_of(slot, start);
        const std::uint64_t size = slot.size_of_entries(slot.count);
        if (!has(place, size)) return fail(slot.path, place, size);
      }
    }
    start += known;
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
    const FieldSlot& variable = layout.slots[layout.variable_slots[i]];
    start = end_of(variable, place_of(variable, start)).value_or(start);
  }
  return place_of(slot, start);
}

}  // namespace aims
