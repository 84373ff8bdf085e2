// SPDX-License-Identifier: BSD-3-Clause
#include "bench/jobs/unit_runner.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <system_error>
#include <utility>

#include "bench/jobs/process_pool.hpp"
#include "core/stopwatch.hpp"

namespace aims {
namespace {

/// Walks that stay open between runs: each holds its truth, 8 MB for four minutes.
constexpr std::size_t kOpenWalks = 32;
constexpr double kPatience = 0.2;  ///< between looks at the observer [s]

/// One walk and the units that wait for it.
struct WalkWork {
  enum class State { kMissing, kBeingMade, kReady };

  std::string id;
  std::vector<const SweepUnit*> units;
  std::size_t next = 0;  ///< the first unit that was not started
  State state = State::kMissing;
  bool remade = false;  ///< its file could not be read, and was made once more

  const Scenario& scenario() const { return *units.front()->scenario; }
  std::uint64_t seed() const { return units.front()->seed; }
  /// Its walk is needed by units that are not started.
  bool is_waited_for() const { return state != State::kReady || next < units.size(); }
  bool has_unit() const { return state == State::kReady && next < units.size(); }
};

/// What a process does: simulate the walk, or evaluate the unit.
struct Task {
  WalkWork* walk = nullptr;
  const SweepUnit* unit = nullptr;  ///< none: the walk itself
};

std::string reply(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

/// In a process of its own: simulates a walk.
std::string make_walk(const WalkCache& cache, const WalkWork& walk) {
  const auto made = cache.make(walk.scenario(), walk.seed());
  if (!made) return reply({{"error", made.error().message}});
  if (made->refusal) return reply({{"refusal", *made->refusal}});
  return reply({{"made", made->simulated}});
}

/// In a process of its own: evaluates a unit and stores what it came to.
std::string do_unit(const RecordedWalk& walk, const SweepUnit& unit, const Evaluate& evaluate,
                    const UnitFolder& folder) {
  const Stopwatch stopwatch;
  UnitResult result;
  const auto outcome = evaluate(walk, *unit.scenario, text_of(unit.estimator));
  if (outcome) {
    result.scores = estimator_json(*outcome);
  } else {
    result.outcome = UnitOutcome::kFailed;
    result.message = outcome.error().message;
  }
  result.wall_s = stopwatch.seconds();
  if (auto stored = folder.put(unit, result); !stored) {
    return reply({{"error", stored.error().message}});
  }
  return reply({{"failed", result.outcome != UnitOutcome::kDone}});
}

}  // namespace

/// One invocation: which process does what, and when.
class UnitRunner::Schedule {
 public:
  Schedule(UnitRunner& runner, std::span<const SweepUnit> units, const UnitObserver& observer)
      : runner_(runner), observer_(observer), pool_(runner.options_.jobs) {
    for (const SweepUnit& unit : units) add(unit);
    for (WalkWork& walk : walks_) {
      if (runner_.cache_.has(walk.id)) walk.state = WalkWork::State::kReady;
      if (runner_.options_.walks_only) walk.next = walk.units.size();
      progress_.total += walk.units.size() - walk.next;
    }
  }

  Result<UnitRun> run() {
    prune();
    while (run_.complete) {
      if (auto started = start_all(); !started) return tl::unexpected(started.error());
      if (pool_.is_idle()) break;
      for (const EndedProcess& ended : pool_.wait(kPatience)) {
        if (auto taken = take(ended); !taken) return tl::unexpected(taken.error());
      }
      run_.complete = tell();
    }
    run_.done = progress_.done;
    run_.failed = progress_.failed;
    run_.walks = progress_.walks;
    run_.pruned = runner_.pruned();
    return run_;
  }

 private:
  /// Adds a unit to its walk, unless it is done.
  void add(const SweepUnit& unit) {
    const auto result = runner_.folder_.find(unit.id);
    const bool again = result && result->outcome != UnitOutcome::kDone && runner_.options_.retry;
    if (result && !again) {
      ++run_.reused;
      return;
    }
    const std::string id = runner_.walk_id(unit);
    auto walk = index_.find(id);
    if (walk == index_.end()) {
      walk = index_.emplace(id, walks_.size()).first;
      walks_.push_back({id, {}});
    }
    walks_[walk->second].units.push_back(&unit);
  }

  /// Fills the pool: with units of the first walk that is there, else with the next walk, so that
  /// processes work on few walks at a time and share their memory.
  Result<void> start_all() {
    while (pool_.has_room()) {
      const auto unit = std::find_if(walks_.begin(), walks_.end(),
                                     [](const WalkWork& walk) { return walk.has_unit(); });
      const auto missing = std::find_if(walks_.begin(), walks_.end(), [](const WalkWork& walk) {
        return walk.state == WalkWork::State::kMissing;
      });
      if (unit != walks_.end()) {
        if (auto started = start_unit(*unit); !started) return started;
      } else if (missing != walks_.end()) {
        missing->state = WalkWork::State::kBeingMade;
        auto started = start({&*missing, nullptr}, 0.0,
                             [this, &walk = *missing] { return make_walk(runner_.cache_, walk); });
        if (!started) return started;
      } else {
        return {};
      }
    }
    return {};
  }

  Result<void> start_unit(WalkWork& walk) {
    const auto open = runner_.open(walk.id, walk.scenario());
    if (!open && !walk.remade) {  // e.g. cut short by a power failure
      walk.remade = true;
      walk.state = WalkWork::State::kMissing;
      std::error_code ignored;
      std::filesystem::remove(runner_.cache_.file_of(walk.id), ignored);
      return {};
    }
    if (!open) return tl::unexpected(open.error());
    const SweepUnit& unit = *walk.units[walk.next++];
    return start({&walk, &unit}, runner_.options_.timeout_s, [this, &unit, walk = *open] {
      return do_unit(*walk, unit, runner_.evaluate_, runner_.folder_);
    });
  }

  Result<void> start(Task task, double timeout_s, const std::function<std::string()>& work) {
    tasks_.push_back(task);
    return pool_.start(tasks_.size() - 1, timeout_s, work);
  }

  Result<void> take(const EndedProcess& ended) {
    const Task& task = tasks_[ended.key];
    Json said = Json::object();
    if (ended.end == ProcessEnd::kReturned) said = Json::parse(ended.text, nullptr, false);
    if (said.contains("error")) return failure(said["error"].get<std::string>());
    return task.unit == nullptr ? take_walk(*task.walk, ended, said)
                                : take_unit(*task.unit, ended, said);
  }

  Result<void> take_walk(WalkWork& walk, const EndedProcess& ended, const Json& said) {
    walk.state = WalkWork::State::kReady;
    progress_.walks += said.value("made", false) ? 1 : 0;
    if (said.value("made", false)) prune();
    const bool crashed = ended.end != ProcessEnd::kReturned;
    if (!crashed && !said.contains("refusal")) return {};
    const std::string why = crashed ? ended.text : said["refusal"].get<std::string>();
    while (walk.next < walk.units.size()) {
      auto stored = fail(*walk.units[walk.next++], UnitOutcome::kFailed,
                         "the walk could not be simulated: " + why);
      if (!stored) return stored;
    }
    return {};
  }

  Result<void> take_unit(const SweepUnit& unit, const EndedProcess& ended, const Json& said) {
    if (ended.end == ProcessEnd::kTimedOut) {
      return fail(unit, UnitOutcome::kTimedOut,
                  fmt::format("stopped after {:g} s", runner_.options_.timeout_s));
    }
    if (ended.end == ProcessEnd::kCrashed) return fail(unit, UnitOutcome::kCrashed, ended.text);
    ++progress_.done;
    if (said.value("failed", false)) ++progress_.failed;
    return {};
  }

  /// Keeps the cache within its limit, but for walks that are still to be read.
  void prune() {
    std::set<std::string> kept = runner_.options_.kept_walks;
    for (const WalkWork& walk : walks_) {
      if (runner_.options_.walks_only || walk.is_waited_for()) kept.insert(walk.id);
    }
    runner_.prune(std::move(kept));
  }

  /// Stores what its own process could not.
  Result<void> fail(const SweepUnit& unit, UnitOutcome outcome, std::string message) {
    ++progress_.done;
    ++progress_.failed;
    UnitResult result;
    result.outcome = outcome;
    result.message = std::move(message);
    return runner_.folder_.put(unit, result);
  }

  bool tell() {
    progress_.elapsed_s = stopwatch_.seconds();
    progress_.left_s.reset();
    if (progress_.done > 0) {
      progress_.left_s = progress_.elapsed_s *
                         static_cast<double>(progress_.total - progress_.done) /
                         static_cast<double>(progress_.done);
    }
    return observer_(progress_);
  }

  UnitRunner& runner_;
  const UnitObserver& observer_;
  ProcessPool pool_;
  std::vector<WalkWork> walks_;
  std::map<std::string, std::size_t> index_;  ///< of the walks, by id
  std::vector<Task> tasks_;                   ///< by key
  UnitProgress progress_;
  UnitRun run_;
  Stopwatch stopwatch_;
};

UnitRunner::UnitRunner(UnitOptions options, Evaluate evaluate)
    : options_(std::move(options)),
      evaluate_(std::move(evaluate)),
      folder_(options_.units),
      cache_(options_.cache) {}

Result<UnitRun> UnitRunner::run(std::span<const SweepUnit> units, const UnitObserver& observer) {
  return Schedule(*this, units, observer).run();
}

std::string UnitRunner::walk_id(const SweepUnit& unit) {
  const auto key = std::pair(unit.scenario, unit.seed);
  const auto known = walk_ids_.find(key);
  if (known != walk_ids_.end()) return known->second;
  return walk_ids_.emplace(key, WalkCache::id_of(*unit.scenario, unit.seed)).first->second;
}

Result<const RecordedWalk*> UnitRunner::open(const std::string& id, const Scenario& scenario) {
  const auto same = [&id](const OpenWalk& each) { return each.id == id; };
  const auto known = std::find_if(open_.begin(), open_.end(), same);
  if (known != open_.end()) return known->walk.get();
  // Without a lock the walk may go while it is read, which takes nothing from who has it open.
  auto in_use = cache_.use(id);
  auto walk = open_walk(cache_.file_of(id), scenario);
  if (!walk) return tl::unexpected(walk.error());
  if (open_.size() == kOpenWalks) open_.erase(open_.begin());
  open_.push_back({id, std::make_unique<const RecordedWalk>(std::move(*walk)), std::move(in_use)});
  return open_.back().walk.get();
}

void UnitRunner::prune(std::set<std::string> kept) {
  if (options_.cache_limit == 0) return;
  const CachePruned now = cache_.prune(options_.cache_limit, kept);
  pruned_.walks += now.walks;
  pruned_.bytes += now.bytes;
  pruned_.left = now.left;
}

}  // namespace aims
