// SPDX-License-Identifier: BSD-3-Clause
#include "cli/progress.hpp"

#include <fmt/format.h>
#include <unistd.h>
#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <utility>

#include "cli/command.hpp"
#include "cli/terminal.hpp"
#include "core/text.hpp"

namespace aims {

namespace {

constexpr double kLineEvery = 10.0;  ///< where standard error is no terminal [s]

volatile std::sig_atomic_t noted = 0;  ///< the signal that came first

/// `timeout` and schedulers may send SIGTERM twice at once, so that only Ctrl-C ends it then.
void on_interrupt(int signal) {
  if (noted == 0) noted = signal;
  if (signal == SIGINT) std::signal(SIGINT, SIG_DFL);
}

bool is_terminal() { return isatty(STDERR_FILENO) != 0; }

/// "45 s", "12 min 05 s" or "3 h 05 min".
std::string duration_text(double seconds) {
  const int whole = static_cast<int>(seconds + 0.5);
  if (whole < 60) return fmt::format("{} s", whole);
  if (whole < 3600) return fmt::format("{} min {:02} s", whole / 60, whole % 60);
  return fmt::format("{} h {:02} min", whole / 3600, whole % 3600 / 60);
}

std::string figures(const Progress& progress, const std::string& done) {
  const double factor = progress.wall_s > 0.0 ? progress.simulated_s / progress.wall_s : 0.0;
  const double ahead = std::max(0.0, progress.expected_s - progress.simulated_s);
  const double left = factor > 0.0 ? ahead / factor : 0.0;
  return fmt::format("{:5.0f} s of about {:.0f} s {}, {:.1f}x real time, {:.0f} s left",
                     progress.simulated_s, progress.expected_s, done, factor, left);
}

std::string bar(double fraction) {
  constexpr int kWidth = 24;
  const int filled = static_cast<int>(kWidth * fraction);
  return std::string(filled, '#') + std::string(kWidth - filled, '.');
}

}  // namespace

void watch_interrupt() {
  std::signal(SIGINT, on_interrupt);
  std::signal(SIGTERM, on_interrupt);
  // A lost ssh connection; under nohup it stays ignored.
  if (std::signal(SIGHUP, on_interrupt) == SIG_IGN) std::signal(SIGHUP, SIG_IGN);
}

bool interrupted() { return noted != 0; }

int interrupted_code() { return noted == 0 ? kInterrupted : 128 + noted; }

ProgressDisplay::ProgressDisplay(std::string label, bool quiet, std::string done)
    : label_(std::move(label)), done_(std::move(done)), quiet_(quiet), terminal_(is_terminal()) {}

bool ProgressDisplay::show(std::optional<std::uint64_t> seed, const Progress& progress) {
  if (quiet_) return !interrupted();
  if (seed != seed_shown_) {
    close();
    seed_shown_ = seed;
    tenths_shown_ = 0;
  }
  const std::string label = seed ? fmt::format("{} seed {}", label_, *seed) : label_;
  const double fraction = std::clamp(progress.simulated_s / progress.expected_s, 0.0, 1.0);
  if (terminal_) {
    fmt::print(stderr, "\r{} [{}] {} ", terminal_text(label), bar(fraction),
               figures(progress, done_));
    bar_open_ = true;
  } else if (const int tenths = static_cast<int>(10.0 * fraction); tenths > tenths_shown_) {
    tenths_shown_ = tenths;
    fmt::print(stderr, "{}: {}\n", terminal_text(label), figures(progress, done_));
  }
  std::fflush(stderr);
  return !interrupted();
}

void ProgressDisplay::close() {
  if (bar_open_) fmt::print(stderr, "\n");
  bar_open_ = false;
}

JobDisplay::JobDisplay(bool quiet) : quiet_(quiet), terminal_(is_terminal()) {}

JobObserver JobDisplay::observer() {
  return [this](const JobProgress& progress) {
    show(progress);
    return !interrupted();
  };
}

void JobDisplay::close() {
  if (open_) fmt::print(stderr, "\n");
  open_ = false;
}

void JobDisplay::show(const JobProgress& progress) {
  const bool due = terminal_ || progress.elapsed_s >= shown_at_s_ + kLineEvery ||
                   progress.done == progress.total;
  if (quiet_ || !due) return;
  std::string line =
      fmt::format("{:3.0f} %, {} of {}{} jobs", std::floor(100.0 * progress.fraction),
                  progress.done, progress.at_most ? "at most " : "", progress.total);
  if (progress.failed > 0) line += fmt::format(", {} failed", progress.failed);
  if (progress.sequences > 0) line += fmt::format(", {} sequences simulated", progress.sequences);
  if (line == shown_ && !terminal_) return;
  shown_ = line;
  shown_at_s_ = progress.elapsed_s;
  line += ", " + duration_text(progress.elapsed_s);
  if (progress.left_s) line += fmt::format(", {} left", duration_text(*progress.left_s));
  fmt::print(stderr, "{}{}{}", terminal_ ? "\r" : "", line, terminal_ ? "    " : "\n");
  open_ = terminal_;
  std::fflush(stderr);
}

namespace {

constexpr const char* kClearLine = "\r\x1b[K";

/// The name that a folder gets when all is in it (core/files/output_folder.hpp).
std::filesystem::path final_name(std::filesystem::path folder) {
  return folder.extension() == ".partial" ? folder.replace_extension() : folder;
}

}  // namespace

DrawDisplay::DrawDisplay(bool quiet) : quiet_(quiet), terminal_(isatty(STDERR_FILENO) != 0) {}

DrawObserver DrawDisplay::observer() {
  return [this](const std::filesystem::path& file) { show(file); };
}

void DrawDisplay::show(const std::filesystem::path& file) {
  if (quiet_) return;
  const std::filesystem::path folder = final_name(file.parent_path());
  if (terminal_) {
    std::fputs(kClearLine, stderr);
    write_terminal(stderr, "drawing " + name_text((folder / file.filename()).string()));
    open_ = true;
  } else if (folder != folder_) {
    folder_ = folder;
    print_error("drawing " + folder_.string());
  }
  std::fflush(stderr);
}

void DrawDisplay::close() {
  if (open_) std::fputs(kClearLine, stderr);
  open_ = false;
}

}  // namespace aims
