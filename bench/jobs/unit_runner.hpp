// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <list>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "bench/jobs/evaluate.hpp"
#include "bench/jobs/sweep_unit.hpp"
#include "bench/jobs/unit_folder.hpp"
#include "bench/jobs/walk_cache.hpp"
#include "core/error.hpp"

namespace aims {

/// What a cache of walks may hold unless told otherwise [bytes].
inline constexpr std::uintmax_t kCacheLimit = 20'000'000'000;

struct UnitOptions {
  std::filesystem::path units;  ///< folder of results, one file per unit
  std::filesystem::path cache = WalkCache::default_folder();  ///< of simulated walks
  /// Of the cache's walks [bytes]; 0: any. Units' walks stay while they wait for them.
  std::uintmax_t cache_limit = kCacheLimit;
  std::set<std::string> kept_walks = {};  ///< ids that others wait for
  int jobs = 1;                           ///< processes at a time; the results do not depend on it
  double timeout_s = 0.0;                 ///< wall time that a unit is given [s]; 0: any
  bool retry = false;                     ///< do what failed before again
  bool walks_only = false;                ///< simulate what is missing and evaluate nothing
};

/// How far the units have come.
struct UnitProgress {
  std::size_t done = 0;    ///< of this invocation, failures included
  std::size_t failed = 0;  ///< of them
  std::size_t total = 0;   ///< without those that were found finished
  std::size_t walks = 0;   ///< simulated
  double elapsed_s = 0.0;
  std::optional<double> left_s;  ///< none before anything is known
};

/// Returning false ends the work with what is finished.
using UnitObserver = std::function<bool(const UnitProgress&)>;

/// What an invocation did.
struct UnitRun {
  std::size_t done = 0;    ///< evaluated now, failures included
  std::size_t failed = 0;  ///< of them
  std::size_t reused = 0;  ///< found finished
  std::size_t walks = 0;   ///< simulated now
  bool complete = true;    ///< false when the observer ended it early
  CachePruned pruned;      ///< from the cache, in all runs of the runner
};

/// Runs an estimator over a walk; `evaluate`, but for tests.
using Evaluate = std::function<Result<EstimatorOutcome>(
    const RecordedWalk& walk, const Scenario& scenario, const std::string& estimator)>;

/// Does units, each in a process of its own, so that one that crashes or hangs is recorded as such
/// and stops nothing else. Each walk is simulated once, also in a process of its own, and read by
/// all units on it. The calling process must not have other threads that work meanwhile.
///
///   UnitRunner runner({.units = out / "units", .jobs = 2});
///   runner.run(units, observer);                       // those that are not there yet
///   const auto result = runner.folder().find(units[0].id);
class UnitRunner {
 public:
  explicit UnitRunner(UnitOptions options, Evaluate evaluate = aims::evaluate);

  /// Does those of the units that have no result. A unit that fails is a result; an error is what
  /// keeps all units from being done, e.g. a full disk.
  Result<UnitRun> run(std::span<const SweepUnit> units, const UnitObserver& observer);

  const UnitFolder& folder() const { return folder_; }

  /// What went from the cache so far.
  const CachePruned& pruned() const { return pruned_; }

 private:
  class Schedule;
  struct OpenWalk {
    std::string id;
    std::unique_ptr<const RecordedWalk> walk;
    std::optional<FolderLock> in_use;
  };

  std::string walk_id(const SweepUnit& unit);
  /// The open walk; opens it, and closes the one that was opened first when there are many.
  Result<const RecordedWalk*> open(const std::string& id, const Scenario& scenario);
  /// Keeps the cache within its limit, but for the walks of these ids.
  void prune(std::set<std::string> kept);

  UnitOptions options_;
  Evaluate evaluate_;
  UnitFolder folder_;
  WalkCache cache_;
  std::map<std::pair<std::shared_ptr<const Scenario>, std::uint64_t>, std::string> walk_ids_;
  std::list<OpenWalk> open_;  ///< kept from run to run
  CachePruned pruned_;
};

}  // namespace aims
