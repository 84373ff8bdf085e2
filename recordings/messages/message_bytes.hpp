// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string_view>
#include <type_traits>
#include <vector>

#include "core/time.hpp"

namespace aims {

/// Serializes values as ROS 1 does: little endian, without padding, a uint32 length before strings
/// and variable arrays.
class MessageBytes {
 public:
  template <class Number>
  requires std::is_arithmetic_v<Number>
  void put(Number value) { append(&value, sizeof(value)); }

  void reserve(std::size_t size) { bytes_.reserve(size); }

  void length(std::size_t count) { put(static_cast<std::uint32_t>(count)); }

  void text(std::string_view value) {
    length(value.size());
    append(value.data(), value.size());
  }

  /// A `time`: whole seconds and nanoseconds, since the epoch; `value` >= 0.
  void time(Time value) {
    put(static_cast<std::uint32_t>(value / kSecond));
    put(static_cast<std::uint32_t>(value % kSecond));
  }

  /// A variable array of numbers.
  template <class Container>
  void array(const Container& values) {
    length(std::size(values));
    append(std::data(values), std::size(values) * sizeof(*std::data(values)));
  }

  void append(const void* data, std::size_t size) {
    if (size > 0) std::memcpy(extend(size), data, size);
  }

  /// Appends `size` uninitialized bytes; the pointer is valid until the next call.
  std::byte* extend(std::size_t size) {
    bytes_.resize(bytes_.size() + size);
    return bytes_.data() + (bytes_.size() - size);
  }

  std::span<const std::byte> view() const { return bytes_; }

 private:
  std::vector<std::byte> bytes_;
};

}  // namespace aims
