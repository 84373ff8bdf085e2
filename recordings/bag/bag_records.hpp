// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "core/error.hpp"
#include "core/files/byte_cursor.hpp"
#include "core/time.hpp"

namespace aims {

/// The first bytes of a bag. Format: http://wiki.ros.org/Bags/Format/2.0
inline constexpr std::string_view kBagMagic = "#ROSBAG V2.0\n";
/// Header and padding of the file's first record together, as rosbag writes it [bytes].
inline constexpr std::uint32_t kFileHeaderSize = 4096;
/// Bytes of one entry in an index record: time and offset.
inline constexpr std::size_t kIndexEntrySize = 12;

enum class BagOp : std::uint8_t {
  kMessage = 2,
  kFileHeader = 3,
  kIndex = 4,
  kChunk = 5,
  kChunkInfo = 6,
  kConnection = 7,
};

/// Name of the record type in errors.
std::string_view name_of(BagOp op);

/// Named values of a record's header, in place: `name=value`, each with its length before it.
class RecordFields {
 public:
  RecordFields() = default;
  /// Error when the lengths are inconsistent or a field has no name.
  static Result<RecordFields> parse(std::span<const std::byte> bytes);

  std::optional<std::span<const std::byte>> find(std::string_view name) const;
  /// A number, or nothing when the field has another size.
  template <class T>
  std::optional<T> number(std::string_view name) const {
    const auto value = find(name);
    if (!value || value->size() != sizeof(T)) return std::nullopt;
    return load_number<T>(value->data());
  }
  std::optional<std::string_view> text(std::string_view name) const;
  std::optional<Time> time(std::string_view name) const;
  std::optional<BagOp> op() const;

 private:
  std::span<const std::byte> bytes_;
};

/// Seconds and nanoseconds, four bytes each, as nanoseconds.
Time load_time(const std::byte* bytes);
void append_time(std::vector<std::byte>& out, Time time);

/// A record inside bytes already in memory.
struct BagRecord {
  RecordFields header;
  BagOp op = BagOp::kMessage;
  std::span<const std::byte> data;
};

/// The record at the cursor; the error states what was expected, not where.
Result<BagRecord> read_record(ByteCursor& cursor);

/// Builds the header of a record: fields in the order added.
class HeaderBuilder {
 public:
  explicit HeaderBuilder(std::vector<std::byte>& out);
  HeaderBuilder& bytes(std::string_view name, std::span<const std::byte> value);
  HeaderBuilder& text(std::string_view name, std::string_view value);
  template <class T>
  HeaderBuilder& number(std::string_view name, T value) {
    return bytes(name, {reinterpret_cast<const std::byte*>(&value), sizeof(T)});
  }
  HeaderBuilder& time(std::string_view name, Time value);
  HeaderBuilder& op(BagOp value);
  /// Writes the length of the header.
  void finish();

 private:
  std::vector<std::byte>& out_;
  std::size_t start_;
};

/// Appends a length and the bytes.
void append_data(std::vector<std::byte>& out, std::span<const std::byte> data);

}  // namespace aims
