// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/messages/message_plan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <type_traits>
#include <utility>

#include "recordings/messages/message_definition.hpp"

namespace aims {
namespace {

constexpr int kMostDepth = 16;
constexpr std::size_t kMostSlots = 4096;
constexpr std::uint64_t kMostFixedBytes = std::uint64_t{1} << 28;
constexpr std::uint32_t kTimeSize = 8;

struct BuiltinType {
  std::string_view name;
  FieldKind kind = FieldKind::kNumber;
  NumberType number = NumberType::kUint8;
};

constexpr std::array<BuiltinType, 16> kBuiltins = {{
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
    {"duration", FieldKind::kTime, NumberType::kInt32},
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

MessageSlot builtin_slot(const BuiltinType& type, const FieldDefinition& field) {
  MessageSlot slot;
  slot.path = field.name;
  slot.kind = field.array == ArrayKind::kNone ? type.kind : array_of(type.kind);
  slot.number = type.number;
  slot.is_bool = type.name == "bool";
  slot.is_signed = type.number == NumberType::kInt32;
  slot.counted = field.array == ArrayKind::kVariable;
  slot.count = field.count;
  if (type.kind == FieldKind::kNumber) {
    slot.entry_size = static_cast<std::uint32_t>(size_of(type.number));
  } else if (type.kind == FieldKind::kTime) {
    slot.entry_size = kTimeSize;
  }
  return slot;
}

/// The columns that a slot of a row makes; false when it is nothing of a table's.
bool add_columns(const MessageSlot& slot, std::vector<ColumnLayout>& columns) {
  if (slot.kind == FieldKind::kTime) {
    const NumberType type = slot.is_signed ? NumberType::kInt32 : NumberType::kUint32;
    columns.push_back({slot.path + ".sec", type, slot.offset, 1});
    columns.push_back({slot.path + ".nsec", type, slot.offset + 4, 1});
    return true;
  }
  if (slot.kind != FieldKind::kNumber && slot.kind != FieldKind::kNumbers) return false;
  columns.push_back({slot.path, slot.number, slot.offset, slot.count});
  return true;
}

// Plans hold views into their own paths: a growing list must move them, never copy.
static_assert(std::is_nothrow_move_constructible_v<MessagePlan>);

class Planner {
 public:
  explicit Planner(std::vector<TypeDefinition> types)
      : types_(std::move(types)), states_(types_.size()) {}

  Result<std::uint32_t> plan(std::size_t type, int depth);
  std::vector<MessagePlan> take() { return std::move(plans_); }

 private:
  struct State {
    bool under_way = false;
    std::optional<std::uint32_t> plan;
  };

  std::optional<std::size_t> find_type(const std::string& name, const std::string& user) const;
  Result<void> add_field(const FieldDefinition& field, const std::string& user, int depth,
                         MessagePlan& plan);
  Result<void> add_slot(MessageSlot slot, MessagePlan& plan);
  Result<void> add_nested(const FieldDefinition& field, std::uint32_t nested, MessagePlan& plan);
  static void finish(MessagePlan& plan);

  std::vector<TypeDefinition> types_;
  std::vector<State> states_;
  std::vector<MessagePlan> plans_;
  std::size_t slots_ = 0;
};

/// A name without package is of the user's package; "Header" is std_msgs'. Where that is not there,
/// the only type of that name will do.
std::optional<std::size_t> Planner::find_type(const std::string& name,
                                              const std::string& user) const {
  const bool bare = name.find('/') == std::string::npos;
  const std::string package = user.substr(0, user.find('/'));
  const std::string wanted =
      !bare ? name : (name == "Header" ? "std_msgs/Header" : package + "/" + name);
  std::optional<std::size_t> alike;
  for (std::size_t i = 1; i < types_.size(); ++i) {
    if (types_[i].name == wanted) return i;
    if (bare && types_[i].name.ends_with("/" + name)) {
      if (alike) return std::nullopt;
      alike = i;
    }
  }
  return alike;
}

Result<void> Planner::add_slot(MessageSlot slot, MessagePlan& plan) {
  if (++slots_ > kMostSlots) return failure(fmt::format("more than {} fields", kMostSlots));
  slot.segment = static_cast<std::uint32_t>(plan.segment_sizes.size() - 1);
  slot.offset = plan.segment_sizes.back();
  if (slot.is_open()) {
    plan.open_slots.push_back(static_cast<std::uint32_t>(plan.slots.size()));
    plan.segment_sizes.push_back(0);
  } else {
    const std::uint64_t size = std::uint64_t{slot.entry_size} * slot.count;
    if (size + slot.offset > kMostFixedBytes) {
      return failure(fmt::format("field '{}' makes the message larger than {} bytes", slot.path,
                                 kMostFixedBytes));
    }
    plan.segment_sizes.back() += static_cast<std::uint32_t>(size);
  }
  plan.slots.push_back(std::move(slot));
  return {};
}

Result<void> Planner::add_nested(const FieldDefinition& field, std::uint32_t nested,
                                 MessagePlan& plan) {
  plan.depth = std::max(plan.depth, plans_[nested].depth + 1);
  if (plan.depth > kMostDepth) {
    return failure(fmt::format("messages nested deeper than {}", kMostDepth));
  }
  if (field.array == ArrayKind::kNone) {
    for (MessageSlot slot : plans_[nested].slots) {
      slot.path = field.name + "." + slot.path;
      if (auto added = add_slot(std::move(slot), plan); !added) return added;
    }
    return {};
  }
  const MessagePlan& element = plans_[nested];
  if (element.is_fixed() && element.fixed_size() == 0) {
    return failure(fmt::format("field '{}' is an array of empty messages", field.name));
  }
  MessageSlot slot;
  slot.path = field.name;
  slot.kind = FieldKind::kMessages;
  slot.counted = field.array == ArrayKind::kVariable;
  slot.count = field.count;
  slot.element = nested;
  slot.entry_size = element.is_fixed() ? element.fixed_size() : 0;
  return add_slot(std::move(slot), plan);
}

Result<void> Planner::add_field(const FieldDefinition& field, const std::string& user, int depth,
                                MessagePlan& plan) {
  if (const BuiltinType* type = builtin(field.type)) {
    return add_slot(builtin_slot(*type, field), plan);
  }
  const auto type = find_type(field.type, user);
  if (!type) {
    return failure(fmt::format("line {}: unknown message definition '{}' of field '{}'", field.line,
                               field.type, field.name));
  }
  const auto nested = this->plan(*type, depth + 1);
  if (!nested) return tl::unexpected(nested.error());
  return add_nested(field, *nested, plan);
}

void Planner::finish(MessagePlan& plan) {
  std::vector<ColumnLayout> columns;
  const auto is_column = [&](const MessageSlot& slot) { return add_columns(slot, columns); };
  if (plan.is_fixed() && std::all_of(plan.slots.begin(), plan.slots.end(), is_column)) {
    plan.columns = std::move(columns);
  }
  for (std::uint32_t i = 0; i < plan.slots.size(); ++i) plan.by_path[plan.slots[i].path] = i;
}

Result<std::uint32_t> Planner::plan(std::size_t type, int depth) {
  if (states_[type].plan) return *states_[type].plan;
  const std::string& name = types_[type].name;
  if (states_[type].under_way) return failure(fmt::format("type '{}' holds itself", name));
  if (depth > kMostDepth) return failure(fmt::format("messages nested deeper than {}", kMostDepth));
  states_[type].under_way = true;
  MessagePlan plan;
  plan.type = name;
  plan.segment_sizes.push_back(0);
  for (const FieldDefinition& field : types_[type].fields) {
    const auto added = add_field(field, name, depth, plan);
    if (!added) return tl::unexpected(added.error());
  }
  plans_.push_back(std::move(plan));
  // The map's keys point into the paths: they are made where the paths stay.
  finish(plans_.back());
  const auto place = static_cast<std::uint32_t>(plans_.size() - 1);
  if (plans_.back().by_path.size() != plans_.back().slots.size()) {
    return failure(fmt::format("type '{}' names a field twice", name));
  }
  states_[type].plan = place;
  return place;
}

}  // namespace

Result<std::vector<MessagePlan>> plan_message(std::string_view type, std::string_view definition) {
  auto types = parse_definition(type, definition);
  if (!types) return tl::unexpected(types.error());
  Planner planner(std::move(*types));
  const auto root = planner.plan(0, 1);
  if (!root) {
    return failure(fmt::format("definition of '{}': {}", type.substr(0, 80), root.error().message));
  }
  return planner.take();
}

}  // namespace aims
