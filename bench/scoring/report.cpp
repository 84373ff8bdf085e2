// SPDX-License-Identifier: BSD-3-Clause
#include "bench/scoring/report.hpp"

#include <fmt/format.h>

#include <cstdint>
#include <system_error>

#include "core/files/atomic_file.hpp"

namespace aims {

std::string number_text(const std::optional<double>& value, const std::string& format,
                        const char* none) {
  return value ? fmt::format(fmt::runtime(format), *value) : none;
}

std::string interval_text(const Interval& interval, const std::string& format, const char* none) {
  if (!interval.low || !interval.high) return none;
  return fmt::format("[{}, {}]", number_text(interval.low, format),
                     number_text(interval.high, format));
}

Json interval_json(const Interval& interval) {
  return Json::array({json_of(interval.low), json_of(interval.high)});
}

std::string cell_text(const Json& value, const std::string& format, const char* none) {
  if (value.is_null()) return none;
  if (value.is_string()) return value.get<std::string>();
  if (!value.is_number_float()) return value.dump();
  return number_text(value.get<double>(), format);
}

void add_cell(const Json& value, CsvTable& table) {
  if (value.is_string()) {
    table.add(value.get<std::string>());
  } else if (value.is_boolean()) {
    table.add(value.get<bool>());
  } else if (value.is_number_float()) {
    table.add(value.get<double>());
  } else if (value.is_number()) {
    table.add(value.get<std::int64_t>());
  } else {
    table.add_empty();
  }
}

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
  if (report.json && written) {
    written = write_json(folder / (report.name + ".json"), *report.json, report.indent);
  }
  if (report.latex) write(".tex", *report.latex);
  return written;
}

}  // namespace aims
