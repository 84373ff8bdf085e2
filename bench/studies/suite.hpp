// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "bench/run/catalogue.hpp"
#include "bench/run/gates.hpp"
#include "bench/run/score_record.hpp"
#include "core/error.hpp"

namespace aims {

/// Version of the layout of suite.json; see docs/results.md.
inline constexpr std::string_view kSuiteSchema = "aims.suite/1";

struct SuiteOptions {
  std::vector<std::uint64_t> seeds;  ///< of every scenario; empty: each scenario's own
  std::filesystem::path out;         ///< folder that is filled, or continued
  int jobs = 1;                      ///< runs at a time, one thread each
  bool trajectories = false;         ///< keep what `aims run` writes of each run, not only scores
  bool weak_axis_series = false;     ///< keep each run's errors along the weak axis over time
};

/// One scenario of a suite and its finished runs, by seed.
struct SuiteCase {
  Scenario scenario;
  std::vector<RunRecord> runs;
  std::vector<GateCheck> gates;
};

/// A scenario that could not be loaded, or not be run on a seed.
struct SuiteFailure {
  std::string scenario;
  std::optional<std::uint64_t> seed;
  std::string message;
};

struct Suite {
  std::vector<SuiteCase> cases;
  std::vector<SuiteFailure> failures;
  std::vector<std::string> notes;  ///< what was there and ran again, and why
  bool complete = true;            ///< false when the observer ended it early
  std::size_t runs_done = 0;       ///< simulated by this invocation
  std::size_t runs_reused = 0;     ///< found finished
};

/// How far a suite has come, in runs of this invocation.
struct SuiteProgress {
  std::size_t done = 0;
  std::size_t total = 0;
  double elapsed_s = 0.0;
  std::optional<double> left_s;  ///< none before anything is known
};

/// Called from one thread at a time; returning false ends the suite with what is finished.
using SuiteObserver = std::function<bool(const SuiteProgress&)>;

/// Runs every scenario on every seed, unless `out` has it already under the same ids (job_id), and
/// writes each as soon as it is finished; then matrices, families and gates over all of it. The
/// estimators that a scenario and seed lack share one simulation. The files are the same for any
/// number of jobs and of interruptions, but for those with times in them. What cannot run is
/// recorded and stops nothing else. Error when `out` is something else or in use, or two scenarios
/// have one name.
Result<Suite> run_suite(std::vector<ScenarioFile> scenarios, const SuiteOptions& options,
                        const SuiteObserver& observer);

}  // namespace aims
