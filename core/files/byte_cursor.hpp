// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstring>
#include <optional>
#include <span>
#include <string_view>
#include <type_traits>
#include <vector>

namespace aims {

static_assert(std::endian::native == std::endian::little, "numbers are read without byte swapping");

/// The little-endian number at `bytes`, aligned or not; `bytes` holds at least sizeof(T).
template <class T>
requires std::is_arithmetic_v<T> T load_number(const std::byte* bytes) {
  T value;
  std::memcpy(&value, bytes, sizeof(T));
  return value;
}

/// The number at `bytes` in either byte order.
template <class T>
requires std::is_arithmetic_v<T> T load_number(const std::byte* bytes, std::endian order) {
  if (order == std::endian::little) return load_number<T>(bytes);
  std::byte swapped[sizeof(T)];
  std::reverse_copy(bytes, bytes + sizeof(T), swapped);
  return load_number<T>(swapped);
}

/// Reads untrusted bytes from front to back, with bounds checks.
class ByteCursor {
 public:
  explicit ByteCursor(std::span<const std::byte> bytes) : bytes_(bytes) {}

  std::size_t position() const { return position_; }
  std::size_t left() const { return bytes_.size() - position_; }

  /// The next `count` bytes, or nothing when fewer are left (and the cursor stays).
  std::optional<std::span<const std::byte>> take(std::size_t count) {
    if (count > left()) return std::nullopt;
    const auto taken = bytes_.subspan(position_, count);
    position_ += count;
    return taken;
  }

  /// The next little-endian number, or nothing when too few bytes are left.
  template <class T>
  std::optional<T> number() {
    const auto taken = take(sizeof(T));
    if (!taken) return std::nullopt;
    return load_number<T>(taken->data());
  }

 private:
  std::span<const std::byte> bytes_;
  std::size_t position_ = 0;
};

/// Bytes as text, without a copy.
inline std::string_view as_text(std::span<const std::byte> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// Text as bytes, without a copy.
inline std::span<const std::byte> bytes_of(std::string_view text) {
  return {reinterpret_cast<const std::byte*>(text.data()), text.size()};
}

/// Appends bytes at the end of `out`.
inline void append(std::vector<std::byte>& out, std::span<const std::byte> bytes) {
  out.insert(out.end(), bytes.begin(), bytes.end());
}

/// Appends a little-endian number at the end of `out`.
template <class T>
requires std::is_arithmetic_v<T>
void append_number(std::vector<std::byte>& out, T value) {
  append(out, {reinterpret_cast<const std::byte*>(&value), sizeof(T)});
}

}  // namespace aims
