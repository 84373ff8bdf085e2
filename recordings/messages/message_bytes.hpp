// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string_view>
#include <type_traits>
#include <vector>

#include "core/time.hpp"
#include "recordings/messages/message_type.hpp"

namespace aims {

/// Serializes values little endian, with a uint32 length before texts and variable arrays: without
/// padding as ROS 1 does, or as CDR, where numbers are aligned to their size behind a header of
/// four bytes and texts end with a zero.
class MessageBytes {
 public:
  explicit MessageBytes(Serialization serialization = Serialization::kRos1)
      : cdr_(serialization == Serialization::kCdr) {
    constexpr std::array<std::byte, kCdrHeader> kLittleEndian = {std::byte{0}, std::byte{1}};
    if (cdr_) append(kLittleEndian.data(), kLittleEndian.size());
  }

  bool is_cdr() const { return cdr_; }

  template <class Number>
  requires std::is_arithmetic_v<Number>
  void put(Number value) {
    align(sizeof(value));
    append(&value, sizeof(value));
  }

  /// Pads so that what follows is aligned to `size` bytes, in CDR.
  void align(std::size_t size) {
    while (cdr_ && (bytes_.size() - kCdrHeader) % size != 0) bytes_.push_back(std::byte{0});
  }

  void reserve(std::size_t size) { bytes_.reserve(size); }

  void length(std::size_t count) { put(static_cast<std::uint32_t>(count)); }

  void text(std::string_view value) {
    length(value.size() + (cdr_ ? 1 : 0));
    append(value.data(), value.size());
    if (cdr_) bytes_.push_back(std::byte{0});
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
    if (std::size(values) > 0) align(sizeof(*std::data(values)));
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
  static constexpr std::size_t kCdrHeader = 4;

  bool cdr_;
  std::vector<std::byte> bytes_;
};

}  // namespace aims
