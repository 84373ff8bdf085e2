// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "bench/jobs/job_runner.hpp"
#include "bench/tuning/sweep_plan.hpp"
#include "core/error.hpp"

namespace aims {

/// A plan as it is given on the command line: a file, and what goes on top of it.
struct PlanArguments {
  std::string file;    ///< empty: none
  std::string folder;  ///< of scenarios; empty: the default
  std::vector<std::string> scenarios;
  std::vector<std::string> tags;
  std::string seeds;
  std::vector<std::string> estimators;  ///< pieces of specs, as split at commas
  std::vector<std::string> over;
  std::vector<std::string> set;
  std::string design;
  std::optional<int> samples;
  std::optional<int> design_seed;
  std::optional<double> timeout;
};

/// PLAN, --folder, --scenarios, --tags, --seeds, --estimators, --over, --set, --design, --samples,
/// --design-seed and --timeout.
void add_plan_options(CLI::App& command, PlanArguments& arguments);

/// The plan of the file with the options on top: what is given replaces what the file says.
Result<SweepPlan> plan_of(const PlanArguments& arguments);

/// Where simulated walks are kept, and how many.
struct CacheArguments {
  std::string folder;                   ///< empty: the default
  double limit_gb = kCacheLimit / 1e9;  ///< 0: any
};

/// --cache and --cache-limit.
void add_cache_options(CLI::App& command, CacheArguments& arguments);

/// The limit in bytes. Error for a size that is none.
Result<std::uintmax_t> limit_of(const CacheArguments& arguments);

/// Says what went from the cache, and when more is needed than it may hold; else nothing.
void print_pruned(const CachePruned& pruned, const CacheArguments& arguments);

/// Shows how far units are: a line that changes on a terminal, now and then a line elsewhere.
class JobDisplay {
 public:
  explicit JobDisplay(bool quiet) : quiet_(quiet) {}
  ~JobDisplay() { close(); }
  JobDisplay(const JobDisplay&) = delete;
  JobDisplay& operator=(const JobDisplay&) = delete;

  /// Shows each step and wants no more after Ctrl-C; must not outlive the display.
  JobObserver observer();
  /// Ends the line.
  void close();

 private:
  void show(const JobProgress& progress);

  bool quiet_;
  bool terminal_ = isatty(STDERR_FILENO) != 0;
  bool open_ = false;
  std::string shown_;
  double shown_at_s_ = 0.0;
};

}  // namespace aims
