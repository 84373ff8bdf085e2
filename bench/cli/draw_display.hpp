// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

#include "bench/run/draw_observer.hpp"

namespace aims {

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
