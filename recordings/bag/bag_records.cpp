// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/bag/bag_records.hpp"

#include <fmt/format.h>

#include <array>

namespace aims {
namespace {

struct Field {
  std::string_view name;
  std::span<const std::byte> value;
};

/// The field at the cursor, or nothing when it is incomplete.
std::optional<Field> next_field(ByteCursor& cursor) {
  const auto size = cursor.number<std::uint32_t>();
  if (!size) return std::nullopt;
  const auto bytes = cursor.take(*size);
  if (!bytes) return std::nullopt;
  const std::size_t equals = as_text(*bytes).find('=');
  if (equals == std::string_view::npos || equals == 0) return std::nullopt;
  return Field{as_text(bytes->first(equals)), bytes->subspan(equals + 1)};
}

}  // namespace

std::string_view name_of(BagOp op) {
  static constexpr std::array<std::string_view, 8> kNames = {
      "nothing",         "a message type", "a message",      "the file header",
      "an index record", "a chunk",        "a chunk's info", "a connection"};
  return kNames[static_cast<std::size_t>(op)];
}

Result<RecordFields> RecordFields::parse(std::span<const std::byte> bytes) {
  ByteCursor cursor(bytes);
  while (cursor.left() > 0) {
    const std::size_t start = cursor.position();
    if (!next_field(cursor)) {
      return failure(fmt::format("expected a field 'name=value' at byte {} of a header of {} bytes",
                                 start, bytes.size()));
    }
  }
  RecordFields fields;
  fields.bytes_ = bytes;
  return fields;
}

std::optional<std::span<const std::byte>> RecordFields::find(std::string_view name) const {
  ByteCursor cursor(bytes_);
  while (const auto field = next_field(cursor)) {
    if (field->name == name) return field->value;
  }
  return std::nullopt;
}

std::optional<std::string_view> RecordFields::text(std::string_view name) const {
  const auto value = find(name);
  if (!value) return std::nullopt;
  return as_text(*value);
}

std::optional<Time> RecordFields::time(std::string_view name) const {
  const auto value = find(name);
  if (!value || value->size() != 8) return std::nullopt;
  return load_time(value->data());
}

std::optional<BagOp> RecordFields::op() const {
  const auto value = number<std::uint8_t>("op");
  if (!value || *value < 2 || *value > 7) return std::nullopt;
  return static_cast<BagOp>(*value);
}

Time load_time(const std::byte* bytes) {
  return static_cast<Time>(load_number<std::uint32_t>(bytes)) * kSecond +
         static_cast<Time>(load_number<std::uint32_t>(bytes + 4));
}

void append_time(std::vector<std::byte>& out, Time time) {
  append_number(out, static_cast<std::uint32_t>(time / kSecond));
  append_number(out, static_cast<std::uint32_t>(time % kSecond));
}

Result<BagRecord> read_record(ByteCursor& cursor) {
  const auto header_size = cursor.number<std::uint32_t>();
  if (!header_size) return failure(fmt::format("expected a record, found {} bytes", cursor.left()));
  const auto header = cursor.take(*header_size);
  if (!header) {
    return failure(
        fmt::format("expected a header of {} bytes, found {}", *header_size, cursor.left()));
  }
  const auto fields = RecordFields::parse(*header);
  if (!fields) return tl::unexpected(fields.error());
  const auto op = fields->op();
  if (!op) return failure("expected a record's header with 'op' from 2 to 7");
  const auto size = cursor.number<std::uint32_t>();
  if (!size) return failure("expected the length of the record's data, found the end");
  const auto data = cursor.take(*size);
  if (!data) {
    return failure(
        fmt::format("expected {} bytes of {}, found {}", *size, name_of(*op), cursor.left()));
  }
  return BagRecord{*fields, *op, *data};
}

HeaderBuilder::HeaderBuilder(std::vector<std::byte>& out) : out_(out), start_(out.size()) {
  append_number(out_, std::uint32_t{0});
}

HeaderBuilder& HeaderBuilder::bytes(std::string_view name, std::span<const std::byte> value) {
  append_number(out_, static_cast<std::uint32_t>(name.size() + 1 + value.size()));
  append(out_, bytes_of(name));
  out_.push_back(std::byte{'='});
  append(out_, value);
  return *this;
}

HeaderBuilder& HeaderBuilder::text(std::string_view name, std::string_view value) {
  return bytes(name, bytes_of(value));
}

HeaderBuilder& HeaderBuilder::time(std::string_view name, Time value) {
  std::array<std::uint32_t, 2> parts = {static_cast<std::uint32_t>(value / kSecond),
                                        static_cast<std::uint32_t>(value % kSecond)};
  return bytes(name, std::as_bytes(std::span(parts)));
}

HeaderBuilder& HeaderBuilder::op(BagOp value) {
  return number("op", static_cast<std::uint8_t>(value));
}

void HeaderBuilder::finish() {
  const auto size = static_cast<std::uint32_t>(out_.size() - start_ - sizeof(std::uint32_t));
  std::memcpy(out_.data() + start_, &size, sizeof(size));
}

void append_data(std::vector<std::byte>& out, std::span<const std::byte> data) {
  append_number(out, static_cast<std::uint32_t>(data.size()));
  append(out, data);
}

}  // namespace aims
