// SPDX-License-Identifier: BSD-3-Clause
#include "bench/run/seeds.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <optional>

namespace aims {
namespace {

constexpr std::uint64_t kMostSeeds = 10'000;

std::optional<std::uint64_t> parse_seed(std::string_view text) {
  std::uint64_t seed = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), seed);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return seed;
}

/// Appends the seeds of "a" or "a-b"; false when it is neither.
bool append_range(std::string_view text, std::vector<std::uint64_t>& seeds) {
  const auto dash = text.find('-');
  const auto first = parse_seed(text.substr(0, dash));
  const auto last = dash == std::string_view::npos ? first : parse_seed(text.substr(dash + 1));
  if (!first || !last || *last < *first || *last - *first >= kMostSeeds) return false;
  for (std::uint64_t seed = *first; seed <= *last; ++seed) {
    if (std::find(seeds.begin(), seeds.end(), seed) == seeds.end()) seeds.push_back(seed);
  }
  return true;
}

}  // namespace

Result<std::vector<std::uint64_t>> parse_seeds(std::string_view text) {
  std::vector<std::uint64_t> seeds;
  std::string_view rest = text;
  while (true) {
    const auto comma = rest.find(',');
    if (!append_range(rest.substr(0, comma), seeds)) {
      return failure(fmt::format(
          "--seeds: '{}' is not a seed, a range like 1-5, or a list like 1,4,7-9", text));
    }
    if (comma == std::string_view::npos) return seeds;
    rest = rest.substr(comma + 1);
  }
}

}  // namespace aims
