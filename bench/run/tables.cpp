// SPDX-License-Identifier: BSD-3-Clause
#include "bench/run/tables.hpp"

namespace aims {
namespace {

const std::vector<std::string> kDiagnosticsHeader = {"stamp_s",
                                                     "points_in",
                                                     "points_used",
                                                     "iterations",
                                                     "residual_mean",
                                                     "residual_sigma",
                                                     "residual_sigma_prior",
                                                     "O_lidar",
                                                     "O_lidar_prior",
                                                     "C_IL",
                                                     "C_IL_full",
                                                     "D",
                                                     "D_smoothed",
                                                     "gamma_lidar",
                                                     "gamma_leg",
                                                     "innovation_rotation_x",
                                                     "innovation_rotation_y",
                                                     "innovation_rotation_z",
                                                     "innovation_position_x",
                                                     "innovation_position_y",
                                                     "innovation_position_z",
                                                     "smallest_eigenvalue",
                                                     "condition_number",
                                                     "weak_weight",
                                                     "weak_ratio",
                                                     "leg_innovation",
                                                     "leg_updates",
                                                     "position_covariance_xx",
                                                     "position_covariance_xy",
                                                     "position_covariance_xz",
                                                     "position_covariance_yy",
                                                     "position_covariance_yz",
                                                     "position_covariance_zz",
                                                     "rotation_covariance_xx",
                                                     "rotation_covariance_xy",
                                                     "rotation_covariance_xz",
                                                     "rotation_covariance_yy",
                                                     "rotation_covariance_yz",
                                                     "rotation_covariance_zz",
                                                     "time_ms"};

void add_vector(CsvTable& table, const Eigen::Vector3d& v) {
  table.add(v.x()).add(v.y()).add(v.z());
}

/// The upper triangle of a symmetric matrix, row by row.
void add_symmetric(CsvTable& table, const Eigen::Matrix3d& m) {
  table.add(m(0, 0)).add(m(0, 1)).add(m(0, 2)).add(m(1, 1)).add(m(1, 2)).add(m(2, 2));
}

}  // namespace

CsvTable diagnostics_table(const EstimatorOutcome& outcome) {
  CsvTable table(kDiagnosticsHeader);
  for (std::size_t i = 0; i < outcome.result.diagnostics.size(); ++i) {
    const ScanDiagnostics& d = outcome.result.diagnostics[i];
    table.add(to_seconds(d.stamp)).add(d.points_in).add(d.points_used).add(d.iterations);
    table.add(d.residual_mean).add(d.residual_sigma).add(d.residual_sigma_prior);
    table.add(d.O_lidar).add(d.O_lidar_prior).add(d.C_IL).add(d.C_IL_full);
    table.add(d.D).add(d.D_smoothed).add(d.gamma_lidar).add(d.gamma_leg);
    add_vector(table, d.innovation_rotation);
    add_vector(table, d.innovation_position);
    table.add(d.smallest_eigenvalue).add(d.condition_number);
    table.add(d.weak_weight).add(d.weak_ratio);
    table.add(d.leg_innovation).add(d.leg_updates);
    add_symmetric(table, d.position_covariance);
    add_symmetric(table, d.rotation_covariance);
    if (i < outcome.scan_times_ms.size()) table.add(outcome.scan_times_ms[i]);
    table.end_row();
  }
  return table;
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
