// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "bench/metrics/statistics.hpp"
#include "bench/scoring/start_anchor.hpp"
#include "render/page/run_series.hpp"
#include "render/page/series.hpp"

namespace aims {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
/// Stamps of one scan in two files differ by their rounding alone.
constexpr Duration kSameScan = kMillisecond;

/// Series of a page and their columns in diagnostics.csv; one that is missing is not drawn.
const ColumnNames kColumns = {{"D", "D"},
                              {"D_smoothed", "D_smoothed"},
                              {"O_lidar", "O_lidar"},
                              {"C_IL", "C_IL"},
                              {"gamma_lidar", "gamma_lidar"},
                              {"gamma_leg", "gamma_leg"},
                              {"lambda_min", "smallest_eigenvalue"},
                              {"condition_number", "condition_number"},
                              {"weak_weight", "weak_weight"},
                              {"gyro_noise", "gyro_noise"},
                              {"accelerometer_noise", "accelerometer_noise"},
                              {"delay", "delay"},
                              {"leg_innovation", "leg_innovation"},
                              {"points", "points_used"},
                              {"time_ms", "time_ms"}};

/// Upper triangle of the position covariance, row by row, in body axes.
constexpr std::array<const char*, 6> kCovariance = {
    "position_covariance_xx", "position_covariance_xy", "position_covariance_xz",
    "position_covariance_yy", "position_covariance_yz", "position_covariance_zz"};

/// Row of the scan that each pose belongs to, -1 for none; both increase in time.
Result<std::vector<std::ptrdiff_t>> rows_of(const Trajectory& poses, const CsvColumns& table) {
  const auto stamps = table.numbers("stamp_s");
  if (!stamps) return tl::unexpected(stamps.error());
  std::vector<std::ptrdiff_t> rows;
  std::size_t row = 0;
  for (const StampedPose& pose : poses) {
    const double earliest = to_seconds(pose.stamp - kSameScan);
    while (row < stamps->size() && !((*stamps)[row] >= earliest)) ++row;
    const bool same = row < stamps->size() && (*stamps)[row] <= to_seconds(pose.stamp + kSameScan);
    rows.push_back(same ? static_cast<std::ptrdiff_t>(row) : -1);
  }
  return rows;
}

/// Norm of three columns at those rows.
Result<Numbers> norms_of(const CsvColumns& table, const std::string& name,
                         const std::vector<std::ptrdiff_t>& rows) {
  Numbers squares(rows.size(), 0.0);
  for (const char* axis : {"_x", "_y", "_z"}) {
    const auto values = numbers_at(table, name + axis, rows);
    if (!values) return values;
    for (std::size_t i = 0; i < rows.size(); ++i) squares[i] += (*values)[i] * (*values)[i];
  }
  for (double& each : squares) each = std::sqrt(each);
  return squares;
}

/// The six covariance columns at those rows, six numbers a pose.
Result<Numbers> covariances_of(const CsvColumns& table, const std::vector<std::ptrdiff_t>& rows) {
  Numbers values(6 * rows.size(), kNone);
  for (std::size_t k = 0; k < kCovariance.size(); ++k) {
    const auto entries = numbers_at(table, kCovariance[k], rows);
    if (!entries) return entries;
    for (std::size_t i = 0; i < rows.size(); ++i) values[6 * i + k] = (*entries)[i];
  }
  return values;
}

Eigen::Matrix3d covariance_at(const Numbers& values, std::size_t i) {
  const double* c = values.data() + 6 * i;
  Eigen::Matrix3d matrix;
  matrix << c[0], c[1], c[2], c[1], c[3], c[4], c[2], c[4], c[5];
  return matrix;
}

/// Adds three columns, "NAME_longitudinal", "NAME_lateral" and "NAME_vertical".
void add_axes(const std::string& name, const std::array<Numbers, 3>& values, PageData& page,
              Json& json) {
  json[name + "_longitudinal"] = column(values[0], page);
  json[name + "_lateral"] = column(values[1], page);
  json[name + "_vertical"] = column(values[2], page);
}

/// Errors and stated deviations in axes along the true heading, to the left and up.
void add_errors(const Trajectory& poses, const Trajectory& truth, const Numbers& covariances,
                PageData& page, Json& json) {
  std::array<Numbers, 3> errors;
  std::array<Numbers, 3> sigmas;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const auto true_pose = pose_at(truth, poses[i].stamp);
    const Pose& pose = poses[i].pose;
    const Eigen::Quaterniond heading =
        yaw_rotation(yaw_of(true_pose ? true_pose->rotation : pose.rotation)).conjugate();
    Eigen::Vector3d error = Eigen::Vector3d::Constant(kNone);
    if (true_pose) error = heading * (pose.translation - true_pose->translation);
    Eigen::Vector3d variances = Eigen::Vector3d::Constant(kNone);
    if (!covariances.empty()) {
      const Eigen::Matrix3d R = (heading * pose.rotation).toRotationMatrix();
      variances = (R * covariance_at(covariances, i) * R.transpose()).diagonal();
    }
    for (int axis = 0; axis < 3; ++axis) {
      const auto k = static_cast<std::size_t>(axis);
      errors[k].push_back(error[axis]);
      // Empty where the estimator states no covariance, zero in old files.
      sigmas[k].push_back(variances[axis] > 0.0 ? std::sqrt(variances[axis]) : kNone);
    }
  }
  add_axes("error", errors, page, json);
  add_axes("sigma", sigmas, page, json);
}

/// Adds the diagnostics at the poses; the covariances go to `covariances`.
Result<void> add_diagnostics(const CsvColumns& table, const Trajectory& poses, PageData& page,
                             Json& json, Numbers& covariances) {
  const auto rows = rows_of(poses, table);
  if (!rows) return tl::unexpected(rows.error());
  auto added = add_columns(table, kColumns, *rows, page, json);
  if (!added) return added;
  for (const auto& [key, name] : ColumnNames{{"innovation", "innovation_position"},
                                             {"innovation_rotation", "innovation_rotation"}}) {
    const auto norms = norms_of(table, name, *rows);
    if (!norms) return tl::unexpected(norms.error());
    json[key] = column(*norms, page);
  }
  auto values = covariances_of(table, *rows);
  if (!values) return tl::unexpected(values.error());
  covariances = std::move(*values);
  json["position_covariance"] = column(covariances, page, 6);
  return {};
}

/// Longest step between poses that is no gap: as for the scores, and three times the usual one.
Duration longest_step(const Trajectory& poses, double max_gap) {
  std::vector<double> steps;
  for (std::size_t i = 1; i < poses.size(); ++i) {
    steps.push_back(to_seconds(poses[i].stamp - poses[i - 1].stamp));
  }
  return from_seconds(std::max(max_gap, 3.0 * median(steps).value_or(0.0)));
}

/// The poses that are shown, in the world. In the middle of a gap stands a pose without numbers, so
/// that lines break there.
Trajectory shown_poses(const Trajectory& trajectory, const Pose& T_world_odom, double max_gap) {
  const Duration longest = longest_step(trajectory, max_gap);
  Trajectory poses;
  std::size_t next = 0;
  for (const std::size_t i : shown(trajectory.size())) {
    for (; next < i; ++next) {
      const Duration step = trajectory[next + 1].stamp - trajectory[next].stamp;
      if (step <= longest) continue;
      const Pose none{Eigen::Quaterniond(kNone, kNone, kNone, kNone),
                      Eigen::Vector3d::Constant(kNone)};
      poses.push_back({trajectory[next].stamp + step / 2, none});
    }
    poses.push_back({trajectory[i].stamp, T_world_odom * trajectory[i].pose});
  }
  return poses;
}

}  // namespace

Result<Json> series_json(const EstimatorFiles& estimator, const RunFolder& run, double start,
                         PageData& page) {
  if (estimator.trajectory.empty()) return Json();
  const Pose T_world_odom = start_anchor(estimator.trajectory, run.truth, run.scoring);
  const Trajectory poses = shown_poses(estimator.trajectory, T_world_odom, run.scoring.max_gap);
  Json json = poses_json(poses, start, page);
  Numbers covariances;
  if (estimator.diagnostics) {
    auto added = add_diagnostics(*estimator.diagnostics, poses, page, json, covariances);
    if (!added) return tl::unexpected(added.error());
  }
  add_errors(poses, run.truth, covariances, page, json);
  return json;
}

}  // namespace aims
