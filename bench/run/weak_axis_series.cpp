// SPDX-License-Identifier: BSD-3-Clause
#include "bench/run/weak_axis_series.hpp"

#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "core/files/csv_columns.hpp"

namespace aims {
namespace {

/// Deviation along the weak axis that IMU and legs allow, by the stamp of the scan.
std::map<Time, double> leg_bounds(const Sequence& sequence) {
  const RunLocalizability& localizability = sequence.localizability;
  const auto bounds = bounds_without_lidar(sequence.reader.truth(), localizability);
  std::map<Time, double> by_stamp;
  for (std::size_t i = 0; i < bounds.size(); ++i) {
    const Localizability& scan = localizability.scans[i];
    by_stamp[scan.stamp] = bound_along(bounds[i], scan.weak_axis_in_world);
  }
  return by_stamp;
}

}  // namespace

CsvTable weak_axis_table(const Sequence& sequence, const EstimatorOutcome& outcome) {
  CsvTable table({"t_s", "error_m", "sigma_m", "bound_m", "leg_bound_m"});
  if (sequence.truth_trajectory.empty()) return table;
  const auto legs = leg_bounds(sequence);
  const Time start = sequence.truth_trajectory.front().stamp;
  Time next = start;
  for (const WeakAxisError& each : outcome.weak_axis_errors) {
    if (each.stamp < next) continue;
    const auto second =
        static_cast<std::int64_t>((each.stamp - start) / (kSeriesSpacing * kSecond));
    next = start + (second + 1) * kSeriesSpacing * kSecond;
    table.add(second * kSeriesSpacing).add(each.error_m);
    const bool stated = each.variance && *each.variance > 0.0;
    table.add(stated ? std::optional(std::sqrt(*each.variance)) : std::nullopt);
    table.add(each.bound_m);
    const auto leg = legs.find(each.stamp);
    table.add(leg == legs.end() ? std::nullopt : std::optional(leg->second)).end_row();
  }
  return table;
}

Result<ConsistencyRun> read_weak_axis(const std::filesystem::path& file) {
  const auto table = CsvColumns::read(file);
  if (!table) return tl::unexpected(table.error());
  std::vector<std::vector<double>> columns;
  for (const char* name : {"t_s", "error_m", "sigma_m", "bound_m", "leg_bound_m"}) {
    auto numbers = table->numbers(name);
    if (!numbers) return tl::unexpected(numbers.error());
    if (numbers->size() != table->rows()) return failure(file.string() + ": expected " + name);
    columns.push_back(std::move(*numbers));
  }
  const auto or_zero = [](double value) { return std::isfinite(value) ? value : 0.0; };
  ConsistencyRun run;
  for (std::size_t i = 0; i < table->rows(); ++i) {
    const double sigma = columns[2][i];
    run.push_back({columns[0][i], or_zero(columns[1][i]),
                   std::isfinite(sigma) ? std::optional(sigma) : std::nullopt,
                   or_zero(columns[3][i]), or_zero(columns[4][i])});
  }
  return run;
}

}  // namespace aims
