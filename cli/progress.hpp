// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "bench/estimate/progress.hpp"
#include "bench/jobs/job_runner.hpp"

namespace aims {

/// From now on Ctrl-C, SIGTERM and SIGHUP are noted; a second Ctrl-C ends the program at once.
void watch_interrupt();

/// True after one of them.
bool interrupted();

/// The exit code after it, as shells have it: 128 + the number of the signal.
int interrupted_code();

/// Shows the progress of one sequence on standard error: a bar on a terminal, plain lines
/// elsewhere.
class ProgressDisplay {
 public:
  /// `done` is what happens to the seconds that it counts: "simulated", "read".
  ProgressDisplay(std::string label, bool quiet, std::string done = "simulated");
  ~ProgressDisplay() { close(); }
  ProgressDisplay(const ProgressDisplay&) = delete;
  ProgressDisplay& operator=(const ProgressDisplay&) = delete;

  /// Shows the seed that is being run, if any; false once `interrupted`.
  bool show(std::optional<std::uint64_t> seed, const Progress& progress);
  /// Ends the bar's line.
  void close();

 private:
  std::string label_;
  std::string done_;
  bool quiet_;
  bool terminal_;
  bool bar_open_ = false;
  std::optional<std::uint64_t> seed_shown_;
  int tenths_shown_ = 0;
};

/// Shows how many jobs are done: a line that changes on a terminal, a line every 10 s elsewhere.
class JobDisplay {
 public:
  explicit JobDisplay(bool quiet);
  ~JobDisplay() { close(); }
  JobDisplay(const JobDisplay&) = delete;
  JobDisplay& operator=(const JobDisplay&) = delete;

  /// Shows each step and returns false once `interrupted`; must not outlive the display.
  JobObserver observer();
  /// Ends the line.
  void close();

 private:
  void show(const JobProgress& progress);

  bool quiet_;
  bool terminal_;
  bool open_ = false;
  std::string shown_;
  double shown_at_s_ = 0.0;
};

/// Shows which picture or page is drawn on standard error: a line that changes on a terminal, a
/// line per folder elsewhere.
class DrawDisplay {
 public:
  explicit DrawDisplay(bool quiet);
  ~DrawDisplay() { close(); }
  DrawDisplay(const DrawDisplay&) = delete;
  DrawDisplay& operator=(const DrawDisplay&) = delete;

  /// Shows each file; must not outlive the display.
  DrawObserver observer();
  /// Clears the line.
  void close();

 private:
  void show(const std::filesystem::path& file);

  bool quiet_;
  bool terminal_;
  bool open_ = false;
  std::filesystem::path folder_;
};

}  // namespace aims
