// SPDX-License-Identifier: BSD-3-Clause
#include "bench/scenario/seeds.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "core/text.hpp"

namespace aims {
namespace {

constexpr std::uint64_t kMostSeeds = 10'000;
constexpr std::uint64_t kLargestSeed = 2'147'483'647;  ///< of the key `seed`, an int

/// What one entry of the list says.
struct SeedRange {
  std::uint64_t first = 0;
  std::uint64_t last = 0;
};

/// "a" or "a-b"; nothing when it is neither.
std::optional<SeedRange> parse_range(std::string_view text) {
  const auto dash = text.find('-');
  const auto first = number_from<std::uint64_t>(text.substr(0, dash));
  const auto last =
      dash == std::string_view::npos ? first : number_from<std::uint64_t>(text.substr(dash + 1));
  if (!first || !last || *last < *first) return std::nullopt;
  return SeedRange{*first, *last};
}

Error beyond(std::string_view text, const std::string& what) {
  return {fmt::format("--seeds: '{}': {}; allowed are up to {} seeds, each at most {}", text, what,
                      kMostSeeds, kLargestSeed)};
}

}  // namespace

Result<std::vector<std::uint64_t>> parse_seeds(std::string_view text) {
  std::vector<std::uint64_t> seeds;
  std::string_view rest = text;
  while (true) {
    const auto comma = rest.find(',');
    const auto range = parse_range(rest.substr(0, comma));
    if (!range) {
      return failure(fmt::format(
          "--seeds: '{}' is not a seed, a range like 1-5, or a list like 1,4,7-9", text));
    }
    if (range->last > kLargestSeed) {
      return tl::unexpected(beyond(text, fmt::format("{} is too large", range->last)));
    }
    if (range->last - range->first >= kMostSeeds - seeds.size()) {
      return tl::unexpected(beyond(text, "too many seeds"));
    }
    for (std::uint64_t seed = range->first; seed <= range->last; ++seed) {
      if (std::find(seeds.begin(), seeds.end(), seed) == seeds.end()) seeds.push_back(seed);
    }
    if (comma == std::string_view::npos) return seeds;
    rest = rest.substr(comma + 1);
  }
}

}  // namespace aims
