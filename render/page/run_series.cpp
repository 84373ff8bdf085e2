// SPDX-License-Identifier: BSD-3-Clause
#include "render/page/run_series.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bench/metrics/localizability.hpp"
#include "render/page/series.hpp"

namespace aims {
namespace {

constexpr Duration kTruthShown = 100 * kMillisecond;
/// A run whose first stamp is less began at 0.
constexpr Time kAtStart = kSecond;

Trajectory thinned_evenly(const Trajectory& trajectory) {
  Trajectory kept;
  for (const std::size_t i : shown(trajectory.size())) kept.push_back(trajectory[i]);
  return kept;
}

/// Intervals of rows whose flag is set, each from the row before it to its last row.
Json intervals(const Numbers& flags, const Numbers& t) {
  Json list = Json::array();
  for (std::size_t i = 0; i < flags.size(); ++i) {
    if (flags[i] != 1.0) continue;
    const double begin = t[i > 0 ? i - 1 : 0];
    while (i + 1 < flags.size() && flags[i + 1] == 1.0) ++i;
    list.push_back({begin, t[i]});
  }
  return list;
}

/// Stamps of a table's rows after `start` [s].
Result<Numbers> stamps_of(const CsvColumns& table, double start) {
  auto stamps = table.numbers("stamp_s");
  if (!stamps) return stamps;
  if (stamps->empty()) stamps->assign(table.rows(), std::numeric_limits<double>::quiet_NaN());
  for (double& each : *stamps) each -= start;
  return stamps;
}

/// Rows of a table that are shown.
std::vector<std::ptrdiff_t> shown_rows(const CsvColumns& table) {
  const auto indices = shown(table.rows());
  return {indices.begin(), indices.end()};
}

/// "t" and the named columns of a table.
Result<Json> columns_json(const CsvColumns& table, const ColumnNames& names, const Numbers& stamps,
                          PageData& page) {
  Numbers t;
  for (const std::size_t row : shown(table.rows())) t.push_back(stamps[row]);
  Json json = {{"t", stamp_column(t, page)}};
  auto added = add_columns(table, names, shown_rows(table), page, json);
  if (!added) return tl::unexpected(added.error());
  return json;
}

/// The weak axis as three numbers a row.
Result<Json> weak_axis_json(const CsvColumns& table, PageData& page) {
  std::vector<Numbers> axes;
  for (const char* name : {"weak_axis_x", "weak_axis_y", "weak_axis_z"}) {
    auto numbers = numbers_at(table, name, shown_rows(table));
    if (!numbers) return tl::unexpected(numbers.error());
    axes.push_back(std::move(*numbers));
  }
  Numbers values;
  for (std::size_t i = 0; i < axes[0].size(); ++i)
    append({axes[0][i], axes[1][i], axes[2][i]}, values);
  return column(values, page, 3);
}

}  // namespace

double page_start(const RunFolder& run) {
  std::optional<Time> first;
  const auto take = [&](const Trajectory& trajectory) {
    if (!trajectory.empty())
      first = std::min(first.value_or(trajectory.front().stamp), trajectory.front().stamp);
  };
  take(run.truth);
  if (!first) {
    for (const EstimatorFiles& each : run.estimators) take(each.trajectory);
  }
  if (!first || std::abs(*first) < kAtStart) return 0.0;
  return to_seconds(*first);
}

Json truth_json(const RunFolder& run, double start, PageData& page) {
  if (run.truth.empty()) return {};
  return poses_json(thinned_evenly(thinned(run.truth, kTruthShown)), start, page);
}

Json waypoint_times_json(const RunFolder& run, double start) {
  Json list = Json::array();
  for (const WaypointTime& each : run.waypoint_times) {
    const auto pose = pose_at(run.truth, each.stamp);
    if (!pose) continue;
    const Eigen::Vector3d& p = pose->translation;
    list.push_back({{"name", each.point},
                    {"t", to_seconds(each.stamp) - start},
                    {"x", p.x()},
                    {"y", p.y()},
                    {"z", p.z()}});
  }
  return list;
}

Result<Json> localizability_json(const RunFolder& run, double start, PageData& page) {
  if (!run.localizability) return Json();
  const CsvColumns& table = *run.localizability;
  const auto stamps = stamps_of(table, start);
  if (!stamps) return tl::unexpected(stamps.error());
  auto json = columns_json(table,
                           {{"equivalent_returns", "equivalent_returns"},
                            {"lambda_min", "lambda_min"},
                            {"crb_sigma", "crb_sigma_m"},
                            {"bound_weak_axis", "bound_weak_axis_m"},
                            {"bound_longitudinal", "bound_longitudinal_m"},
                            {"bound_lateral", "bound_lateral_m"},
                            {"bound_vertical", "bound_vertical_m"}},
                           *stamps, page);
  if (!json) return json;
  auto weak_axis = weak_axis_json(table, page);
  if (!weak_axis) return weak_axis;
  (*json)["weak_axis"] = std::move(*weak_axis);
  for (const DegeneracyLevel& level : kDegeneracyLevels) {
    const auto flags = table.numbers("degenerate_" + std::string(level.name));
    if (!flags) return tl::unexpected(flags.error());
    (*json)["degenerate"][std::string(level.name)] = intervals(*flags, *stamps);
  }
  return json;
}

Result<Json> legs_json(const RunFolder& run, double start, PageData& page) {
  if (!run.legs) return Json();
  const auto stamps = stamps_of(*run.legs, start);
  if (!stamps) return tl::unexpected(stamps.error());
  return columns_json(*run.legs, {{"loss", "loss"}, {"slip", "slip_mps"}}, *stamps, page);
}

}  // namespace aims
