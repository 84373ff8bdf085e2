// SPDX-License-Identifier: BSD-3-Clause
#include "bench/run/tables.hpp"

#include <map>
#include <string>
#include <type_traits>

#include "core/files/csv_columns.hpp"

namespace aims {
namespace {

/// The upper triangle of a symmetric matrix, row by row.
template <class Matrix, class Visit>
void visit_symmetric(const std::string& name, Matrix& m, const Visit& visit) {
  constexpr const char* kAxes[] = {"x", "y", "z"};
  for (int row = 0; row < 3; ++row) {
    for (int column = row; column < 3; ++column) {
      visit(name + "_" + kAxes[row] + kAxes[column], m(row, column));
    }
  }
}

/// Calls `visit(column, number)` for every number of a scan but its stamp, in the columns' order.
template <class Scan, class Visit>
void visit_numbers(Scan& d, const Visit& visit) {
  visit("points_in", d.points_in);
  visit("points_used", d.points_used);
  visit("iterations", d.iterations);
  visit("residual_mean", d.residual_mean);
  visit("residual_sigma", d.residual_sigma);
  visit("residual_sigma_prior", d.residual_sigma_prior);
  visit("O_lidar", d.O_lidar);
  visit("O_lidar_prior", d.O_lidar_prior);
  visit("C_IL", d.C_IL);
  visit("C_IL_full", d.C_IL_full);
  visit("D", d.D);
  visit("D_smoothed", d.D_smoothed);
  visit("gamma_lidar", d.gamma_lidar);
  visit("gamma_leg", d.gamma_leg);
  visit("innovation_rotation_x", d.innovation_rotation.x());
  visit("innovation_rotation_y", d.innovation_rotation.y());
  visit("innovation_rotation_z", d.innovation_rotation.z());
  visit("innovation_position_x", d.innovation_position.x());
  visit("innovation_position_y", d.innovation_position.y());
  visit("innovation_position_z", d.innovation_position.z());
  visit("smallest_eigenvalue", d.smallest_eigenvalue);
  visit("condition_number", d.condition_number);
  visit("weak_weight", d.weak_weight);
  visit("weak_ratio", d.weak_ratio);
  visit("leg_innovation", d.leg_innovation);
  visit("leg_updates", d.leg_updates);
  visit_symmetric("position_covariance", d.position_covariance, visit);
  visit_symmetric("rotation_covariance", d.rotation_covariance, visit);
}

std::vector<std::string> diagnostics_header() {
  std::vector<std::string> header = {"stamp_s"};
  const ScanDiagnostics none;
  visit_numbers(none, [&](const std::string& name, auto) { header.push_back(name); });
  header.emplace_back("time_ms");
  return header;
}

}  // namespace

CsvTable diagnostics_table(const EstimatorOutcome& outcome) {
  CsvTable table(diagnostics_header());
  for (std::size_t i = 0; i < outcome.result.diagnostics.size(); ++i) {
    const ScanDiagnostics& scan = outcome.result.diagnostics[i];
    table.add(to_seconds(scan.stamp));
    visit_numbers(scan, [&](const std::string&, auto number) { table.add(number); });
    if (i < outcome.scan_times_ms.size()) table.add(outcome.scan_times_ms[i]);
    table.end_row();
  }
  return table;
}

Result<std::vector<ScanDiagnostics>> read_diagnostics(const std::filesystem::path& file) {
  const auto table = CsvColumns::read(file);
  if (!table) return tl::unexpected(table.error());
  std::vector<ScanDiagnostics> scans(table->rows());
  std::map<std::string, std::vector<double>> columns;
  for (const std::string& name : table->header()) {
    auto numbers = table->numbers(name);
    if (!numbers) return tl::unexpected(numbers.error());
    columns[name] = std::move(*numbers);
  }
  for (std::size_t i = 0; i < scans.size(); ++i) {
    scans[i].stamp = from_seconds(columns["stamp_s"][i]);
    visit_numbers(scans[i], [&](const std::string& name, auto& number) {
      const auto column = columns.find(name);
      if (column == columns.end()) return;
      number = static_cast<std::remove_reference_t<decltype(number)>>(column->second[i]);
    });
  }
  return scans;
}

CsvTable waypoint_times_table(const std::vector<WaypointTime>& waypoint_times) {
  CsvTable table({"point", "stamp_s"});
  for (const WaypointTime& waypoint_time : waypoint_times) {
    table.add(waypoint_time.point).add(to_seconds(waypoint_time.stamp)).end_row();
  }
  return table;
}

CsvTable scores_csv(std::span<const RunRecord> runs) {
  CsvTable table({"seed", "estimator", "score", "value"});
  for (const RunRecord& run : runs) {
    for (const auto& [estimator, unused] : run.scores["estimators"].items()) {
      for (const std::string& key : score_keys(run, estimator)) {
        table.add(static_cast<std::int64_t>(run.seed)).add(estimator).add(key);
        table.add(find_score(run, estimator, key)).end_row();
      }
    }
  }
  return table;
}

}  // namespace aims
