// SPDX-License-Identifier: BSD-3-Clause
// What a unit of a sweep costs beside its estimator: reading the walk, and a process of its own.
#include <benchmark/benchmark.h>

#include <cstdlib>
#include <filesystem>
#include <string>

#include "bench/jobs/evaluate.hpp"
#include "bench/jobs/process_pool.hpp"
#include "bench/jobs/walk_cache.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;

Scenario walk_of(double metres) {
  Scenario scenario;
  scenario.simulation.scene.corridor.length = metres + 10.0;
  scenario.simulation.route.points = {{"a", 0.0, 0.0}, {"b", metres, 0.0}};
  scenario.simulation.route.stand_before = 2.5;
  return scenario;
}

/// A walk in a folder that goes with the program; made once.
class Walk {
 public:
  Walk() : scenario_(walk_of(3.0)) {
    std::string name = (fs::temp_directory_path() / "aims-bench-XXXXXX").string();
    folder_ = mkdtemp(name.data());
    const WalkCache cache(folder_);
    if (!cache.make(scenario_, 1)) std::abort();
    file_ = cache.file_of(WalkCache::id_of(scenario_, 1));
  }
  Walk(const Walk&) = delete;
  Walk& operator=(const Walk&) = delete;
  ~Walk() { fs::remove_all(folder_); }

  static const Walk& only() {
    static const Walk walk;
    return walk;
  }
  const fs::path& file() const { return file_; }
  const Scenario& scenario() const { return scenario_; }

 private:
  Scenario scenario_;
  fs::path folder_;
  fs::path file_;
};

/// Truth and what the sweeps allow to know: once per walk.
void open_a_walk(benchmark::State& state) {
  for (auto _ : state)
    benchmark::DoNotOptimize(open_walk(Walk::only().file(), Walk::only().scenario()));
}
BENCHMARK(open_a_walk)->Unit(benchmark::kMillisecond);

/// All measurements: once per unit.
void replay_a_walk(benchmark::State& state) {
  const auto walk = open_walk(Walk::only().file(), Walk::only().scenario());
  std::int64_t scans = 0;
  for (auto _ : state) {
    const auto replayed = walk->reader.replay(
        [&](const Delivery& delivery) { scans += delivery.measurement.index() == 2 ? 1 : 0; });
    if (!replayed) state.SkipWithError("not read");
  }
  state.SetBytesProcessed(state.iterations() * static_cast<std::int64_t>(walk->reader.size()));
  state.counters["per_scan_s"] = benchmark::Counter(
      static_cast<double>(scans), benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}
BENCHMARK(replay_a_walk)->Unit(benchmark::kMillisecond);

/// One estimator over the walk, scored: the unit itself.
void evaluate_a_unit(benchmark::State& state) {
  const auto walk = open_walk(Walk::only().file(), Walk::only().scenario());
  for (auto _ : state) benchmark::DoNotOptimize(evaluate(*walk, Walk::only().scenario(), "aims"));
}
BENCHMARK(evaluate_a_unit)->Unit(benchmark::kMillisecond);

/// A process that does nothing, beside an open walk.
void start_a_process(benchmark::State& state) {
  const auto walk = open_walk(Walk::only().file(), Walk::only().scenario());
  ProcessPool pool(1);
  for (auto _ : state) {
    if (!pool.start(0, 0.0, [] { return std::string(); })) state.SkipWithError("no process");
    while (!pool.is_idle()) benchmark::DoNotOptimize(pool.wait(1.0));
  }
}
BENCHMARK(start_a_process)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
}  // namespace aims
