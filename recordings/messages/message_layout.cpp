// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/messages/message_layout.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <type_traits>
#include <utility>

#include "recordings/messages/message_definition.hpp"

namespace aims {
namespace {

constexpr int kMaxDepth = 16;
constexpr std::size_t kMaxSlots = 4096;
constexpr std::uint64_t kMaxFixedBytes = std::uint64_t{1} << 28;
constexpr std::uint32_t kTimeSize = 8;

struct BuiltinType {
  std::string_view name;
  FieldKind kind = FieldKind::kNumber;
  NumberType number = NumberType::kUint8;
  NumberType fraction = NumberType::kUint32;  ///< of a time
};

constexpr std::array<BuiltinType, 18> kBuiltins = {{
    {"bool", FieldKind::kNumber, NumberType::kUint8},
    {"int8", FieldKind::kNumber, NumberType::kInt8},
    {"uint8", FieldKind::kNumber, NumberType::kUint8},
    {"byte", FieldKind::kNumber, NumberType::kInt8},
    {"char", FieldKind::kNumber, NumberType::kUint8},
    {"int16", FieldKind::kNumber, NumberType::kInt16},
    {"uint16", FieldKind::kNumber, NumberType::kUint16},
    {"int32", FieldKind::kNumber, NumberType::kInt32},
    {"uint32", FieldKind::kNumber, NumberType::kUint32},
    {"int64", FieldKind::kNumber, NumberType::kInt64},
    {"uint64", FieldKind::kNumber, NumberType::kUint64},
    {"float32", FieldKind::kNumber, NumberType::kFloat32},
    {"float64", FieldKind::kNumber, NumberType::kFloat64},
    {"string", FieldKind::kText, NumberType::kUint8},
    {"time", FieldKind::kTime, NumberType::kUint32},
    {"duration", FieldKind::kTime, NumberType::kInt32, NumberType::kInt32},
    {"builtin_interfaces/Time", FieldKind::kTime, NumberType::kInt32},
    {"builtin_interfaces/Duration", FieldKind::kTime, NumberType::kInt32},
}};

const BuiltinType* builtin(std::string_view name) {
  const auto found = std::find_if(kBuiltins.begin(), kBuiltins.end(),
                                  [name](const BuiltinType& each) { return each.name == name; });
  return found == kBuiltins.end() ? nullptr : &*found;
}

FieldKind array_of(FieldKind kind) {
  if (kind == FieldKind::kNumber) return FieldKind::kNumbers;
  return kind == FieldKind::kTime ? FieldKind::kTimes : FieldKind::kTexts;
}

FieldSlot builtin_slot(const BuiltinType& type, const FieldDefinition& field) {
  FieldSlot slot;
  slot.path = field.name;
  slot.kind = field.array == ArrayKind::kNone ? type.kind : array_of(type.kind);
  slot.number = type.number;
  slot.fraction = type.fraction;
  slot.is_bool = type.name == "bool";
  slot.counted = field.array == ArrayKind::kVariable;
  slot.count = field.count;
  if (type.kind == FieldKind::kNumber) {
    slot.entry_size = static_cast<std::uint32_t>(size_of(type.number));
  } else if (type.kind == FieldKind::kTime) {
    slot.entry_size = kTimeSize;
  }
  slot.last_size = slot.entry_size;
  return slot;
}

/// Numbers are aligned to their size; a time and the length of a text are words of four bytes.
std::uint32_t cdr_alignment(const BuiltinType& type) {
  if (type.kind != FieldKind::kNumber) return sizeof(std::uint32_t);
  return static_cast<std::uint32_t>(size_of(type.number));
}

/// Appends the table columns of a slot; false for a slot that a table cannot hold.
bool add_columns(const FieldSlot& slot, std::vector<ColumnLayout>& columns) {
  if (slot.is_placeholder) return true;
  if (slot.kind == FieldKind::kTime) {
    columns.push_back({slot.path + ".sec", slot.number, slot.offset[0], 1});
    columns.push_back({slot.path + ".nsec", slot.fraction, slot.offset[0] + 4, 1});
    return true;
  }
  if (slot.kind != FieldKind::kNumber && slot.kind != FieldKind::kNumbers) return false;
  columns.push_back({slot.path, slot.number, slot.offset[0], slot.count});
  return true;
}

// Layouts hold views into their own paths: a growing list must move them, never copy.
static_assert(std::is_nothrow_move_constructible_v<MessageLayout>);

class LayoutBuilder {
 public:
  LayoutBuilder(std::vector<TypeDefinition> types, MessageFormat format)
      : types_(std::move(types)), format_(format), states_(types_.size()) {}

  Result<std::uint32_t> build(std::size_t type, int depth);
  std::vector<MessageLayout> take() { return std::move(layouts_); }

 private:
  struct State {
    bool in_progress = false;
    std::optional<std::uint32_t> layout;
  };

  Result<void> add_field(const FieldDefinition& field, const std::string& user, int depth,
                         MessageLayout& layout);
  std::uint32_t alignment_of(const FieldSlot& slot) const;
  Result<void> add_slot(FieldSlot slot, MessageLayout& layout);
  Result<void> add_nested(const FieldDefinition& field, std::uint32_t nested,
                          MessageLayout& layout);
  static void finish(MessageLayout& layout);

  std::vector<TypeDefinition> types_;
  MessageFormat format_;
  std::vector<State> states_;
  std::vector<MessageLayout> layouts_;
  std::size_t slots_ = 0;
};

/// Of the slot itself: of its count, where it has one.
std::uint32_t LayoutBuilder::alignment_of(const FieldSlot& slot) const {
  if (format_.serialization != Serialization::kCdr) return 1;
  return slot.counted ? std::uint32_t{sizeof(std::uint32_t)} : slot.alignment;
}

Result<void> LayoutBuilder::add_slot(FieldSlot slot, MessageLayout& layout) {
  if (++slots_ > kMaxSlots) return failure(fmt::format("more than {} fields", kMaxSlots));
  slot.segment = static_cast<std::uint32_t>(layout.segment_sizes.size() - 1);
  const std::uint32_t alignment = alignment_of(slot);
  layout.alignment = std::max({layout.alignment, alignment, slot.alignment});
  BytesByPhase& sizes = layout.segment_sizes.back();
  const std::uint64_t size = slot.is_variable() ? 0 : slot.size_of_entries(slot.count);
  for (std::uint32_t phase = 0; phase < sizes.size(); ++phase) {
    const std::uint64_t offset = aligned(phase + sizes[phase], alignment) - phase;
    if (size + offset > kMaxFixedBytes) {
      return failure(fmt::format("field '{}' makes the message larger than {} bytes", slot.path,
                                 kMaxFixedBytes));
    }
    slot.offset[phase] = static_cast<std::uint32_t>(offset);
    sizes[phase] = static_cast<std::uint32_t>(offset + size);
  }
  if (slot.is_variable()) {
    layout.variable_slots.push_back(static_cast<std::uint32_t>(layout.slots.size()));
    layout.segment_sizes.push_back({});
  }
  layout.slots.push_back(std::move(slot));
  return {};
}

Result<void> LayoutBuilder::add_nested(const FieldDefinition& field, std::uint32_t nested,
                                       MessageLayout& layout) {
  layout.depth = std::max(layout.depth, layouts_[nested].depth + 1);
  if (layout.depth > kMaxDepth) {
    return failure(fmt::format("messages nested deeper than {}", kMaxDepth));
  }
  if (field.array == ArrayKind::kNone) {
    for (FieldSlot slot : layouts_[nested].slots) {
      slot.path = field.name + "." + slot.path;
      if (auto added = add_slot(std::move(slot), layout); !added) return added;
    }
    return {};
  }
  const MessageLayout& element = layouts_[nested];
  if (element.is_fixed() && element.fixed_size() == 0) {
    return failure(fmt::format("field '{}' is an array of empty messages", field.name));
  }
  FieldSlot slot;
  slot.path = field.name;
  slot.kind = FieldKind::kMessages;
  slot.counted = field.array == ArrayKind::kVariable;
  slot.count = field.count;
  slot.element = nested;
  if (element.is_regular()) {
    slot.alignment = element.alignment;
    slot.last_size = element.fixed_size();
    slot.entry_size = static_cast<std::uint32_t>(aligned(slot.last_size, slot.alignment));
  }
  return add_slot(std::move(slot), layout);
}

Result<void> LayoutBuilder::add_field(const FieldDefinition& field, const std::string& user,
                                      int depth, MessageLayout& layout) {
  if (const BuiltinType* type = builtin(field.type)) {
    FieldSlot slot = builtin_slot(*type, field);
    if (format_.serialization == Serialization::kCdr) slot.alignment = cdr_alignment(*type);
    // ROS 1 has signed bytes, ROS 2 octets.
    const bool octet = type->name == "byte" && format_.language != DefinitionLanguage::kRos1Msg;
    if (octet) slot.number = NumberType::kUint8;
    slot.is_sequence_number = user == kHeaderType && field.name == kSequenceField;
    return add_slot(std::move(slot), layout);
  }
  if (field.type == "wstring" || field.type == "wchar") {
    return failure(
        fmt::format("line {}: field '{}' is a {}, which the middlewares of ROS 2 "
                    "serialize differently: expected string or char",
                    field.line, field.name, field.type));
  }
  const auto type = find_type(types_, field.type, user);
  if (!type) {
    return failure(fmt::format("line {}: unknown message definition '{}' of field '{}'", field.line,
                               field.type, field.name));
  }
  const auto nested = build(*type, depth + 1);
  if (!nested) return tl::unexpected(nested.error());
  return add_nested(field, *nested, layout);
}

void LayoutBuilder::finish(MessageLayout& layout) {
  std::vector<ColumnLayout> columns;
  const auto is_column = [&](const FieldSlot& slot) { return add_columns(slot, columns); };
  if (layout.is_regular() && std::all_of(layout.slots.begin(), layout.slots.end(), is_column)) {
    layout.columns = std::move(columns);
  }
  for (std::uint32_t i = 0; i < layout.slots.size(); ++i) {
    if (!layout.slots[i].is_placeholder) layout.by_path[layout.slots[i].path] = i;
  }
}

Result<std::uint32_t> LayoutBuilder::build(std::size_t type, int depth) {
  if (states_[type].layout) return *states_[type].layout;
  const std::string& name = types_[type].name;
  if (states_[type].in_progress) return failure(fmt::format("type '{}' holds itself", name));
  if (depth > kMaxDepth) return failure(fmt::format("messages nested deeper than {}", kMaxDepth));
  states_[type].in_progress = true;
  MessageLayout layout;
  layout.type = name;
  layout.serialization = format_.serialization;
  layout.segment_sizes.push_back({});
  for (const FieldDefinition& field : types_[type].fields) {
    const auto added = add_field(field, name, depth, layout);
    if (!added) return tl::unexpected(added.error());
  }
  if (types_[type].fields.empty()) {
    FieldSlot placeholder;
    placeholder.is_placeholder = true;
    placeholder.count = format_.serialization == Serialization::kCdr ? 1 : 0;
    placeholder.entry_size = placeholder.last_size = 1;
    if (auto added = add_slot(std::move(placeholder), layout); !added) {
      return tl::unexpected(added.error());
    }
  }
  layouts_.push_back(std::move(layout));
  // The map's keys point into the paths: they are made where the paths stay.
  finish(layouts_.back());
  const auto place = static_cast<std::uint32_t>(layouts_.size() - 1);
  const auto named = std::ranges::count(layouts_.back().slots, false, &FieldSlot::is_placeholder);
  if (layouts_.back().by_path.size() != static_cast<std::size_t>(named)) {
    return failure(fmt::format("type '{}' names a field twice", name));
  }
  states_[type].layout = place;
  return place;
}

}  // namespace

Result<std::vector<MessageLayout>> message_layouts(std::string_view type,
                                                   std::string_view definition,
                                                   MessageFormat format) {
  auto types = parse_definition(type, definition, format.language);
  if (!types) return tl::unexpected(types.error());
  LayoutBuilder builder(std::move(*types), format);
  const auto root = builder.build(0, 1);
  if (!root) {
    return failure(fmt::format("definition of '{}': {}", type.substr(0, 80), root.error().message));
  }
  return builder.take();
}

}  // namespace aims
