// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.hpp"
#include "core/time.hpp"

namespace aims {

/// The types of a number inside a message or a point.
enum class NumberType {
  kInt8,
  kUint8,
  kInt16,
  kUint16,
  kInt32,
  kUint32,
  kInt64,
  kUint64,
  kFloat32,
  kFloat64,
};

/// Bytes of one number.
std::size_t size_of(NumberType type);

/// The number at `bytes`, little endian; `bytes` holds at least `size_of(type)`.
double number_at(const std::byte* bytes, NumberType type);

/// A field of each row of a table.
struct ColumnLayout {
  std::string name;
  NumberType type = NumberType::kFloat32;
  std::uint32_t offset = 0;  ///< within the row [bytes]
  std::uint32_t count = 1;   ///< numbers one after the other
};

/// Rows of numbers at a fixed stride: a point cloud's data, or an array of messages of fixed size.
/// Every column lies within the stride and `rows * stride <= bytes.size()`.
struct TableView {
  std::vector<ColumnLayout> columns;
  std::size_t stride = 0;  ///< [bytes]
  std::size_t rows = 0;
  std::span<const std::byte> bytes;

  /// The column of that name, or nullptr.
  const ColumnLayout* find(std::string_view name) const;
};

/// What a field of a message holds.
enum class FieldKind { kNumber, kTime, kText, kNumbers, kTimes, kTexts, kMessages };

/// A field of a message, by its path from the message's top; arrays of messages are one field.
struct MessageField {
  std::string path;
  FieldKind kind = FieldKind::kNumber;
  std::optional<NumberType> number;  ///< of numbers; bools are kUint8
  bool is_bool = false;
};

/// One decoded message. Paths are written "pose.pose.position.x", elements "transforms[0].header".
/// A path that the message does not have, or of another kind, gives nothing. Views point into the
/// bytes that were decoded.
class MessageView {
 public:
  std::optional<double> number(std::string_view path) const;  ///< any number, or a bool as 0 or 1
  std::optional<Time> time(std::string_view path) const;      ///< a time or duration
  std::optional<std::string_view> text(std::string_view path) const;
  std::optional<std::vector<double>> numbers(std::string_view path) const;  ///< array of numbers
  std::optional<std::vector<std::string_view>> texts(std::string_view path) const;
  std::optional<std::span<const std::byte>> bytes(
      std::string_view path) const;                              ///< uint8[], int8[]
  std::optional<std::size_t> size(std::string_view path) const;  ///< entries of any array
  /// The entries of an array of messages, each with paths of its own, in one pass: `size` and
  /// "path[i].field" start at the first entry each time.
  std::optional<std::vector<MessageView>> messages(std::string_view path) const;
  /// An array of messages that hold numbers, bools and times alone; a time is two uint32 columns
  /// "name.sec" and "name.nsec", a nested message's fields are "name.field".
  std::optional<TableView> table(std::string_view path) const;

 private:
  friend class MessageDecoder;
  struct Impl;
  std::shared_ptr<const Impl> impl_;
};

/// Decodes the messages of one connection by the definition that the bag itself carries.
class MessageDecoder {
 public:
  /// Error for a definition that cannot be read, naming the line and the type.
  static Result<MessageDecoder> create(std::string_view type, std::string_view definition);

  /// All fields in the order of the definition, those of nested messages in place.
  std::vector<MessageField> fields() const;

  /// Error for bytes that end early or are too many, naming the field and the offset within it.
  /// Memory stays within a small multiple of the bytes given.
  Result<MessageView> decode(std::span<const std::byte> data) const;

 private:
  struct Impl;
  std::shared_ptr<const Impl> impl_;
};

}  // namespace aims
