// SPDX-License-Identifier: BSD-3-Clause
#include "bench/cli/progress_display.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <utility>

namespace aims {
namespace {

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

ProgressDisplay::ProgressDisplay(std::string label, bool quiet, std::string done)
    : label_(std::move(label)),
      done_(std::move(done)),
      quiet_(quiet),
      terminal_(isatty(STDERR_FILENO) != 0) {}

void ProgressDisplay::show(std::optional<std::uint64_t> seed, const Progress& progress) {
  if (quiet_) return;
  if (seed != seed_shown_) {
    close();
    seed_shown_ = seed;
    tenths_shown_ = 0;
  }
  const std::string label = seed ? fmt::format("{} seed {}", label_, *seed) : label_;
  const double fraction = std::clamp(progress.simulated_s / progress.expected_s, 0.0, 1.0);
  if (terminal_) {
    fmt::print(stderr, "\r{} [{}] {} ", label, bar(fraction), figures(progress, done_));
    bar_open_ = true;
  } else if (const int tenths = static_cast<int>(10.0 * fraction); tenths > tenths_shown_) {
    tenths_shown_ = tenths;
    fmt::print(stderr, "{}: {}\n", label, figures(progress, done_));
  }
  std::fflush(stderr);
}

void ProgressDisplay::close() {
  if (bar_open_) fmt::print(stderr, "\n");
  bar_open_ = false;
}

}  // namespace aims
