// SPDX-License-Identifier: BSD-3-Clause
#include "bench/cli/draw_display.hpp"

#include <unistd.h>

#include <cstdio>

#include "bench/cli/terminal.hpp"
#include "core/text.hpp"

namespace aims {
namespace {

constexpr const char* kClearLine = "\r\x1b[K";

}  // namespace

DrawDisplay::DrawDisplay(bool quiet) : quiet_(quiet), terminal_(isatty(STDERR_FILENO) != 0) {}

DrawObserver DrawDisplay::observer() {
  return [this](const std::filesystem::path& file) { show(file); };
}

void DrawDisplay::show(const std::filesystem::path& file) {
  if (quiet_) return;
  if (terminal_) {
    std::fputs(kClearLine, stderr);
    write_terminal(stderr, "drawing " + name_text(file.string()));
    open_ = true;
  } else if (file.parent_path() != folder_) {
    folder_ = file.parent_path();
    print_error("drawing " + folder_.string());
  }
  std::fflush(stderr);
}

void DrawDisplay::close() {
  if (open_) std::fputs(kClearLine, stderr);
  open_ = false;
}

}  // namespace aims
