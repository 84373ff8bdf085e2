// SPDX-License-Identifier: BSD-3-Clause
// What a job of a sweep costs beside its estimator: reading the sequence, and a process of its own.
#include <benchmark/benchmark.h>

#include <cstdlib>
#include <filesystem>
#include <string>

#include "bench/jobs/process_pool.hpp"
#include "bench/jobs/sequence_cache.hpp"
#include "bench/run/evaluate.hpp"

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

/// A sequence in a folder that goes with the program; made once.
class CachedSequence {
 public:
  CachedSequence() : scenario_(walk_of(3.0)) {
    std::string name = (fs::temp_directory_path() / "aims-bench-XXXXXX").string();
    folder_ = mkdtemp(name.data());
    const SequenceCache cache(folder_);
    if (!cache.make(scenario_, 1)) std::abort();
    file_ = cache.file_of(SequenceCache::id_of(scenario_, 1));
  }
  CachedSequence(const CachedSequence&) = delete;
  CachedSequence& operator=(const CachedSequence&) = delete;
  ~CachedSequence() { fs::remove_all(folder_); }

  static const CachedSequence& only() {
    static const CachedSequence sequence;
    return sequence;
  }
  const fs::path& file() const { return file_; }
  const Scenario& scenario() const { return scenario_; }

 private:
  Scenario scenario_;
  fs::path folder_;
  fs::path file_;
};

/// Truth and localizability: once per sequence.
void open_a_sequence(benchmark::State& state) {
  for (auto _ : state)
    benchmark::DoNotOptimize(
        open_sequence(CachedSequence::only().file(), CachedSequence::only().scenario(), 1));
}
BENCHMARK(open_a_sequence)->Unit(benchmark::kMillisecond);

/// All measurements: once per job.
void replay_a_sequence(benchmark::State& state) {
  const auto sequence =
      open_sequence(CachedSequence::only().file(), CachedSequence::only().scenario(), 1);
  std::int64_t scans = 0;
  for (auto _ : state) {
    const auto replayed = sequence->reader.replay(
        [&](const Delivery& delivery) { scans += delivery.measurement.index() == 2 ? 1 : 0; });
    if (!replayed) state.SkipWithError("not read");
  }
  state.SetBytesProcessed(state.iterations() * static_cast<std::int64_t>(sequence->reader.size()));
  state.counters["per_scan_s"] = benchmark::Counter(
      static_cast<double>(scans), benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}
BENCHMARK(replay_a_sequence)->Unit(benchmark::kMillisecond);

/// One estimator over the sequence, scored: the job itself.
void evaluate_a_job(benchmark::State& state) {
  const auto sequence =
      open_sequence(CachedSequence::only().file(), CachedSequence::only().scenario(), 1);
  for (auto _ : state)
    benchmark::DoNotOptimize(
        evaluate(*sequence, CachedSequence::only().scenario(), "aims", [](double) {}));
}
BENCHMARK(evaluate_a_job)->Unit(benchmark::kMillisecond);

/// A process that does nothing, beside an open sequence.
void start_a_process(benchmark::State& state) {
  const auto sequence =
      open_sequence(CachedSequence::only().file(), CachedSequence::only().scenario(), 1);
  ProcessPool pool(1);
  for (auto _ : state) {
    if (!pool.start(0, 0.0, [](auto&) { return std::string(); })) state.SkipWithError("no process");
    while (!pool.is_idle()) benchmark::DoNotOptimize(pool.wait(1.0));
  }
}
BENCHMARK(start_a_process)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
}  // namespace aims
