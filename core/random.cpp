// SPDX-License-Identifier: BSD-3-Clause
#include "core/random.hpp"

#include <boost/random/normal_distribution.hpp>

namespace aims {
namespace {

constexpr std::size_t kMiddle = 156;
constexpr std::uint64_t kLowerBits = 0x7fffffff;  ///< 31 of them
constexpr std::uint64_t kMatrix = 0xb5026f5aa96619e9ULL;

/// The next value of a place, from its own, its neighbour's, and that of the place in the middle.
std::uint64_t twisted(std::uint64_t own, std::uint64_t neighbour, std::uint64_t middle) {
  const std::uint64_t joined = (own & ~kLowerBits) | (neighbour & kLowerBits);
  return middle ^ (joined >> 1) ^ ((0 - (joined & 1)) & kMatrix);
}

}  // namespace

MersenneTwister64::MersenneTwister64(std::uint64_t seed) {
  state_[0] = seed;
  for (std::size_t i = 1; i < kSize; ++i) {
    const std::uint64_t before = state_[i - 1];
    state_[i] = 6364136223846793005ULL * (before ^ (before >> 62)) + i;
  }
}

void MersenneTwister64::turn() {
  for (std::size_t i = 0; i < kSize - kMiddle; ++i) {
    state_[i] = twisted(state_[i], state_[i + 1], state_[i + kMiddle]);
  }
  for (std::size_t i = kSize - kMiddle; i + 1 < kSize; ++i) {
    state_[i] = twisted(state_[i], state_[i + 1], state_[i - (kSize - kMiddle)]);
  }
  state_[kSize - 1] = twisted(state_[kSize - 1], state_[0], state_[kMiddle - 1]);
  for (std::size_t i = 0; i < kSize; ++i) {
    std::uint64_t x = state_[i];
    x ^= (x >> 29) & 0x5555555555555555ULL;
    x ^= (x << 17) & 0x71d67fffeda60000ULL;
    x ^= (x << 37) & 0xfff7eee000000000ULL;
    numbers_[i] = x ^ (x >> 43);
  }
  next_ = 0;
}

namespace {

/// FNV-1a over the name, then the splitmix64 finalizer over name and seed.
std::uint64_t mixed_seed(std::uint64_t run_seed, std::string_view name) {
  std::uint64_t hash = 0xcbf29ce484222325ULL;
  for (const char letter : name) {
    hash = (hash ^ static_cast<unsigned char>(letter)) * 0x100000001b3ULL;
  }
  std::uint64_t mixed = hash + run_seed * 0x9e3779b97f4a7c15ULL;
  mixed = (mixed ^ (mixed >> 30)) * 0xbf58476d1ce4e5b9ULL;
  mixed = (mixed ^ (mixed >> 27)) * 0x94d049bb133111ebULL;
  return mixed ^ (mixed >> 31);
}

}  // namespace

RandomStream::RandomStream(std::uint64_t run_seed, std::string_view name)
    : engine_(mixed_seed(run_seed, name)) {}

double RandomStream::uniform(double low, double high) { return low + (high - low) * uniform(); }

double RandomStream::normal() { return boost::random::normal_distribution<double>()(engine_); }

void RandomStream::normal(std::span<double> values) {
  for (double& value : values) value = normal();
}

Eigen::Vector3d RandomStream::normal3() {
  const double x = normal();
  const double y = normal();
  const double z = normal();
  return {x, y, z};
}

}  // namespace aims
