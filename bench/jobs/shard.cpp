// SPDX-License-Identifier: BSD-3-Clause
#include "bench/jobs/shard.hpp"

#include <fmt/format.h>

#include <charconv>

namespace aims {

Result<Shard> parse_shard(std::string_view text) {
  Shard shard;
  const char* end = text.data() + text.size();
  const auto index = std::from_chars(text.data(), end, shard.index);
  bool right = index.ec == std::errc() && index.ptr != end && *index.ptr == '/';
  if (right) {
    const auto count = std::from_chars(index.ptr + 1, end, shard.count);
    right = count.ec == std::errc() && count.ptr == end;
  }
  if (right && shard.index >= 1 && shard.index <= shard.count) return shard;
  return failure(fmt::format("--shard: expected I/N with I from 1 to N, e.g. 2/8, got '{}'", text));
}

std::span<const Job> part_of(std::span<const Job> jobs, const Shard& shard) {
  const auto border = [&](int index) {
    return jobs.size() * static_cast<std::size_t>(index) / static_cast<std::size_t>(shard.count);
  };
  return jobs.subspan(border(shard.index - 1), border(shard.index) - border(shard.index - 1));
}

}  // namespace aims
