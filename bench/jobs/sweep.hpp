// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "bench/jobs/unit_runner.hpp"
#include "core/error.hpp"

namespace aims {

/// Part `index` of `count` (from 1) of a plan's units.
struct Shard {
  int index = 1;
  int count = 1;
};

/// The shard of "2/8".
Result<Shard> parse_shard(std::string_view text);

/// The shard's units: neighbours, as the plan orders them, so that a shard needs few walks. The
/// shards differ by one unit at most, and together are all units.
std::span<const SweepUnit> part_of(std::span<const SweepUnit> units, const Shard& shard);

struct SweepOptions {
  std::filesystem::path out;    ///< folder that is filled or continued
  std::filesystem::path cache;  ///< of simulated walks; empty: `WalkCache::default_folder()`
  std::uintmax_t cache_limit = kCacheLimit;  ///< of those walks [bytes]; 0: any
  int jobs = 1;                              ///< processes at a time
  Shard shard;
  double timeout_s = 0.0;   ///< wall time that a unit is given [s]; 0: any
  bool retry = false;       ///< do what failed before again
  bool renew = false;       ///< take the plan although the folder is of another plan or code
  bool walks_only = false;  ///< simulate what is missing and evaluate nothing
};

/// Does the shard's units that `out` has no result of, each into `out/units/ID.json`. The folder
/// also gets plan.yaml, the plan (YAML), and units.csv, all units by their ids. Error when the
/// folder is something else, belongs to another plan or to another version of code or scenarios, or
/// when another sweep works on it; shards of one plan may work on it together.
Result<UnitRun> run_sweep(const std::string& plan, std::span<const SweepUnit> units,
                          const SweepOptions& options, const UnitObserver& observer);

}  // namespace aims
