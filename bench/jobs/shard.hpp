// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <string_view>

#include "bench/jobs/job.hpp"
#include "core/error.hpp"

namespace aims {

/// Part `index` of `count` (from 1) of a list of jobs.
struct Shard {
  int index = 1;
  int count = 1;
};

/// The shard of "2/8".
Result<Shard> parse_shard(std::string_view text);

/// The shard's jobs: neighbours in the list, so that a shard needs few sequences. The shards differ
/// by one job at most, and together are all jobs.
std::span<const Job> part_of(std::span<const Job> jobs, const Shard& shard);

}  // namespace aims
