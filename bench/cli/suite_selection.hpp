// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <unistd.h>

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "bench/cli/options.hpp"
#include "bench/studies/suite.hpp"
#include "core/error.hpp"

namespace aims {

/// What every command that runs a suite is given.
struct SuiteSelection {
  std::string folder;  ///< of scenarios
  std::vector<std::string> scenarios;
  std::vector<std::string> tags;
  std::string seeds;
  std::vector<std::string> estimators;  ///< pieces of specs, as split at commas
  std::vector<std::string> overrides;
  std::string out;
  int jobs = default_jobs();
  bool quiet = false;
};

/// --folder, --tags (instead of `names`), --seeds, --set, --out, --jobs and --quiet.
void add_suite_options(CLI::App& command, SuiteSelection& selection, CLI::Option* names);

/// The scenarios that are selected, with settings and estimators on top. Error when there is none.
Result<std::vector<ScenarioFile>> scenarios_of(const SuiteSelection& selection);

/// Seeds, folder and jobs.
Result<SuiteOptions> suite_options(const SuiteSelection& selection);

/// "45 s", "12 min" or "3 h 05 min".
std::string duration_text(double seconds);

/// Shows how far a suite is: a line that changes on a terminal, a line per run elsewhere.
class SuiteDisplay {
 public:
  explicit SuiteDisplay(bool quiet) : quiet_(quiet) {}
  ~SuiteDisplay() { close(); }
  SuiteDisplay(const SuiteDisplay&) = delete;
  SuiteDisplay& operator=(const SuiteDisplay&) = delete;

  /// Shows each step and wants no more after Ctrl-C; must not outlive the display.
  SuiteObserver observer();
  /// Ends the line.
  void close();

 private:
  void show(const SuiteProgress& progress);

  bool quiet_;
  bool terminal_ = isatty(STDERR_FILENO) != 0;
  bool open_ = false;
  std::size_t shown_ = 0;
};

/// Says what a suite noted, what could not run, and whether it was interrupted.
void print_outcome(const Suite& suite);

}  // namespace aims
