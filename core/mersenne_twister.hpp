// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>

namespace aims {

/// The generator MT19937-64 (Matsumoto and Nishimura, 2004), number for number std::mt19937_64. All
/// 312 numbers of a turn of the state are made at once, which compilers vectorize.
class MersenneTwister64 {
 public:
  using result_type = std::uint64_t;

  explicit MersenneTwister64(std::uint64_t seed);

  static constexpr std::uint64_t min() { return 0; }
  static constexpr std::uint64_t max() { return std::numeric_limits<std::uint64_t>::max(); }

  std::uint64_t operator()() {
    if (next_ == kSize) turn();
    return numbers_[next_++];
  }

 private:
  static constexpr std::size_t kSize = 312;

  void turn();

  std::array<std::uint64_t, kSize> state_;
  std::array<std::uint64_t, kSize> numbers_;  ///< of this turn; uninitialized before the first
  std::size_t next_ = kSize;
};

}  // namespace aims
