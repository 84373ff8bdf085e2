// SPDX-License-Identifier: BSD-3-Clause
#include "core/random.hpp"

#include <boost/random/normal_distribution.hpp>

namespace aims {
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
