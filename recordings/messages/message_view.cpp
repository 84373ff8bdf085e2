// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/messages/message_view.hpp"

#include <utility>

#include "core/files/byte_cursor.hpp"
#include "core/text.hpp"
#include "recordings/messages/message_traversal.hpp"
#include "recordings/messages/message_view_impl.hpp"

namespace aims {
namespace {

/// A field of a message, and which of its entries when the path ends in brackets.
struct Found {
  const FieldSlot* slot = nullptr;
  std::size_t start = 0;
  std::optional<std::uint32_t> entry;
};

/// "name[12].rest" as its three parts; the rest begins behind the dot.
struct PathParts {
  std::string_view name;
  std::uint32_t entry = 0;
  std::string_view rest;
};

std::optional<PathParts> split(std::string_view path) {
  const std::size_t open = path.find('[');
  const std::size_t close = path.find(']', open);
  if (open == std::string_view::npos || close == std::string_view::npos) return std::nullopt;
  const auto entry = number_from<std::uint32_t>(path.substr(open + 1, close - open - 1));
  if (!entry) return std::nullopt;
  PathParts parts{path.substr(0, open), *entry, path.substr(close + 1)};
  if (parts.rest.empty()) return parts;
  if (parts.rest[0] != '.') return std::nullopt;
  parts.rest.remove_prefix(1);
  return parts;
}

const FieldSlot* slot_named(const MessageLayout& layout, std::string_view path) {
  const auto found = layout.by_path.find(path);
  return found == layout.by_path.end() ? nullptr : &layout.slots[found->second];
}

/// A number of four bytes.
Time word_at(const std::byte* bytes, NumberType type, std::endian order) {
  const auto word = load_number<std::uint32_t>(bytes, order);
  return type == NumberType::kInt32 ? Time{static_cast<std::int32_t>(word)} : Time{word};
}

Time time_at(const std::byte* bytes, const FieldSlot& slot, std::endian order) {
  return word_at(bytes, slot.number, order) * kSecond + word_at(bytes + 4, slot.fraction, order);
}

double number_of(const std::byte* bytes, const FieldSlot& slot, std::endian order) {
  const double value = number_at(bytes, slot.number, order);
  return slot.is_bool ? static_cast<double>(value != 0.0) : value;
}

/// True for a single value of `one`, or an entry of an array of `many`.
bool is_one(const Found& found, FieldKind one, FieldKind many) {
  return found.slot->kind == one || (found.slot->kind == many && found.entry);
}

}  // namespace

/// Looks paths up in a decoded message.
class FieldLookup {
 public:
  explicit FieldLookup(const MessageView::Impl& message)
      : message_(message), traversal_(*message.layouts, message.bytes, message.order) {}

  std::optional<Found> find(std::string_view path) {
    const std::vector<MessageLayout>& layouts = *message_.layouts;
    const MessageLayout* layout = &message_.layout();
    const std::uint32_t* segments = message_.segments();
    std::size_t message = message_.start;
    while (true) {
      const auto start_of = [&](const FieldSlot& slot) {
        if (segments != nullptr) {
          const std::size_t segment = segments[slot.segment];
          return segment + slot.offset[segment % slot.offset.size()];
        }
        return traversal_.start_of(*layout, slot, message);
      };
      if (const FieldSlot* slot = slot_named(*layout, path)) {
        return Found{slot, start_of(*slot), {}};
      }
      const auto parts = split(path);
      if (!parts) return std::nullopt;
      const FieldSlot* slot = slot_named(*layout, parts->name);
      if (slot == nullptr || !slot->is_array()) return std::nullopt;
      std::size_t start = start_of(*slot);
      const auto count = traversal_.count_of(*slot, start);
      if (!count || parts->entry >= *count) return std::nullopt;
      start = traversal_.start_of_entry(*slot, start, parts->entry);
      if (slot->kind != FieldKind::kMessages) {
        if (!parts->rest.empty()) return std::nullopt;
        return Found{slot, start, parts->entry};
      }
      layout = &layouts[slot->element];
      message = start;
      segments = nullptr;
      path = parts->rest;
    }
  }

  /// The array that a path names: its slot, its first entry, its count.
  std::optional<std::pair<Found, std::uint32_t>> array(std::string_view path) {
    auto found = find(path);
    if (!found || !found->slot->is_array() || found->entry) return std::nullopt;
    const auto count = traversal_.count_of(*found->slot, found->start);
    if (!count) return std::nullopt;
    return std::pair(*found, *count);
  }

  /// The text at a place that was found before.
  TextPlace text(const FieldSlot& slot, std::size_t start) {
    return traversal_.text_at(slot, start).value_or(TextPlace{});
  }

  /// The same, of entries of that kind alone.
  std::optional<std::pair<Found, std::uint32_t>> array(std::string_view path, FieldKind kind) {
    auto found = array(path);
    if (!found || found->first.slot->kind != kind) return std::nullopt;
    return found;
  }

 private:
  const MessageView::Impl& message_;
  MessageTraversal traversal_;
};

std::optional<double> MessageView::number(std::string_view path) const {
  const auto found = FieldLookup(*impl_).find(path);
  if (!found || !is_one(*found, FieldKind::kNumber, FieldKind::kNumbers)) return std::nullopt;
  return number_of(impl_->bytes.data() + found->start, *found->slot, impl_->order);
}

std::optional<Time> MessageView::time(std::string_view path) const {
  const auto found = FieldLookup(*impl_).find(path);
  if (!found || !is_one(*found, FieldKind::kTime, FieldKind::kTimes)) return std::nullopt;
  return time_at(impl_->bytes.data() + found->start, *found->slot, impl_->order);
}

std::optional<std::string_view> MessageView::text(std::string_view path) const {
  FieldLookup lookup(*impl_);
  const auto found = lookup.find(path);
  if (!found || !is_one(*found, FieldKind::kText, FieldKind::kTexts)) return std::nullopt;
  const TextPlace text = lookup.text(*found->slot, found->start);
  return as_text(impl_->bytes.subspan(text.start, text.size));
}

std::optional<std::vector<double>> MessageView::numbers(std::string_view path) const {
  const auto array = FieldLookup(*impl_).array(path, FieldKind::kNumbers);
  if (!array) return std::nullopt;
  const auto& [found, count] = *array;
  std::vector<double> values(count);
  const std::byte* bytes = impl_->bytes.data() + found.start;
  for (std::size_t i = 0; i < values.size(); ++i) {
    values[i] = number_of(bytes + i * found.slot->entry_size, *found.slot, impl_->order);
  }
  return values;
}

std::optional<std::vector<std::string_view>> MessageView::texts(std::string_view path) const {
  FieldLookup lookup(*impl_);
  const auto array = lookup.array(path, FieldKind::kTexts);
  if (!array) return std::nullopt;
  std::vector<std::string_view> values(array->second);
  std::size_t start = array->first.start;
  for (std::string_view& value : values) {
    const TextPlace text = lookup.text(*array->first.slot, start);
    value = as_text(impl_->bytes.subspan(text.start, text.size));
    start = text.end;
  }
  return values;
}

std::optional<std::span<const std::byte>> MessageView::bytes(std::string_view path) const {
  const auto array = FieldLookup(*impl_).array(path, FieldKind::kNumbers);
  if (!array) return std::nullopt;
  const auto& [found, count] = *array;
  if (found.slot->entry_size != 1 || found.slot->is_bool) return std::nullopt;
  return impl_->bytes.subspan(found.start, count);
}

std::optional<std::size_t> MessageView::size(std::string_view path) const {
  const auto array = FieldLookup(*impl_).array(path);
  if (!array) return std::nullopt;
  return array->second;
}

std::optional<std::vector<MessageView>> MessageView::messages(std::string_view path) const {
  const auto array = FieldLookup(*impl_).array(path, FieldKind::kMessages);
  if (!array) return std::nullopt;
  const MessageLayout& entry = (*impl_->layouts)[array->first.slot->element];
  if (array->second > impl_->bytes.size()) return std::nullopt;  // entries without a byte
  std::vector<MessageView> views(array->second);
  MessageTraversal traversal(*impl_->layouts, impl_->bytes, impl_->order);
  std::size_t start = array->first.start;
  for (MessageView& view : views) {
    start = aligned(start, array->first.slot->alignment);
    auto impl = std::make_shared<Impl>();
    impl->layouts = impl_->layouts;
    impl->root = array->first.slot->element;
    impl->bytes = impl_->bytes;
    impl->start = start;
    impl->order = impl_->order;
    impl->make_room(entry.segment_sizes.size());
    const auto end = traversal.end_of(entry, start, impl->segments());
    if (!end) return std::nullopt;
    start = *end;
    view.impl_ = std::move(impl);
  }
  return views;
}

std::optional<TableView> MessageView::table(std::string_view path) const {
  const auto array = FieldLookup(*impl_).array(path, FieldKind::kMessages);
  if (!array) return std::nullopt;
  const auto& [found, count] = *array;
  const MessageLayout& row = (*impl_->layouts)[found.slot->element];
  if (!row.columns) return std::nullopt;
  return TableView{*row.columns, found.slot->entry_size, count,
                   impl_->bytes.subspan(found.start, found.slot->size_of_entries(count)),
                   impl_->order};
}

}  // namespace aims
