// SPDX-License-Identifier: BSD-3-Clause
#include "bench/scoring/report.hpp"

#include <fmt/format.h>

#include <system_error>

#include "core/files/atomic_file.hpp"

namespace aims {

Result<void> write_report(const Report& report, const std::filesystem::path& folder) {
  std::error_code code;
  std::filesystem::create_directories(folder, code);
  if (code) return failure(fmt::format("{}: {}", folder.string(), code.message()));
  Result<void> written;
  const auto write = [&](const char* ending, const std::string& text) {
    if (written) written = write_file_atomically(folder / (report.name + ending), text);
  };
  if (report.markdown) write(".md", *report.markdown);
  if (report.csv && written) written = write_csv(folder / (report.name + ".csv"), *report.csv);
  if (report.json) write(".json", json_text(*report.json, 2) + "\n");
  if (report.latex) write(".tex", *report.latex);
  return written;
}

}  // namespace aims
