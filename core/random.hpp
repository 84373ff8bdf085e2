// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string_view>

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

/// Named stream of random numbers. Its values depend only on the run's seed and its name, so that a
/// new sensor never changes another's noise. Identical on every compiler.
class RandomStream {
 public:
  RandomStream(std::uint64_t run_seed, std::string_view name);

  double uniform() {  ///< in [0, 1)
    while (true) {
      // A number next to 2^64 is rounded to it.
      if (const double value = 0x1p-64 * to_double(engine_()); value < 1.0) return value;
    }
  }
  double uniform(double low, double high);  ///< in [low, high)
  double normal();                          ///< zero mean, unit variance
  void normal(std::span<double> values);    ///< replaces each by a `normal()`, in their order
  Eigen::Vector3d normal3();                ///< three independent `normal()`
  bool chance(double probability) {         ///< true with that probability
    return uniform() < probability;
  }

 private:
  /// Rounded once, as by a conversion, which branches on the highest bit where there is no
  /// instruction for unsigned numbers.
  static double to_double(std::uint64_t number) {
    const auto high = static_cast<double>(static_cast<std::int64_t>(number >> 32));
    return 0x1p32 * high + static_cast<double>(static_cast<std::int64_t>(number & 0xffffffff));
  }

  MersenneTwister64 engine_;
};

/// The stream `name` of the run with that seed, e.g. rng(seed, "imu.gyro").
inline RandomStream rng(std::uint64_t run_seed, std::string_view name) {
  return RandomStream(run_seed, name);
}

}  // namespace aims
