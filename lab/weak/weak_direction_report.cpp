// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <string>

#include "bench/metrics/statistics.hpp"
#include "bench/scoring/report.hpp"
#include "core/files/csv.hpp"
#include "lab/weak/weak_direction.hpp"

namespace aims {
namespace {

using Member = double WeakDirection::*;

struct Source {
  const char* name;
  Member member;
};

constexpr Source kSources[] = {
    {"planes", &WeakDirection::planes},       {"relief", &WeakDirection::relief},
    {"intensity", &WeakDirection::intensity}, {"legs_1m", &WeakDirection::legs},
    {"aims_d", &WeakDirection::believed},     {"range_sigma_m", &WeakDirection::range_sigma}};

CsvTable rows_of(const std::vector<WeakDirection>& runs) {
  std::vector<std::string> header = {"scenario", "seed"};
  for (const Source& source : kSources) header.emplace_back(source.name);
  CsvTable table(header);
  for (const WeakDirection& run : runs) {
    table.add(run.scenario).add(run.seed);
    for (const Source& source : kSources) table.add(run.*source.member);
    table.end_row();
  }
  return table;
}

}  // namespace

TextTable weak_direction_table(const std::vector<WeakDirection>& runs) {
  TextTable table;
  table.header = {"scenario", "runs"};
  for (const Source& source : kSources) table.header.emplace_back(source.name);
  for (std::size_t first = 0; first < runs.size();) {
    std::size_t last = first;
    while (last < runs.size() && runs[last].scenario == runs[first].scenario) ++last;
    std::vector<std::string> row = {runs[first].scenario, std::to_string(last - first)};
    for (const Source& source : kSources) {
      std::vector<double> values;
      for (std::size_t i = first; i < last; ++i) values.push_back(runs[i].*source.member);
      row.push_back(fmt::format("{:.3g}", median(values).value_or(0.0)));
    }
    table.rows.push_back(std::move(row));
    first = last;
  }
  return table;
}

Result<void> write_weak_direction(const std::vector<WeakDirection>& runs,
                                  const std::filesystem::path& folder) {
  Report report{.name = "weak"};
  report.markdown =
      "# What the weak direction holds\n\nEquivalent returns along the weak axis of "
      "the scene with plain surfaces; medians over scans and seeds.\n\n" +
      to_markdown(weak_direction_table(runs));
  report.csv = rows_of(runs);
  return write_report(report, folder);
}

}  // namespace aims
