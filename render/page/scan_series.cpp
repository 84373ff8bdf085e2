// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include "render/page/map_cloud.hpp"
#include "render/page/run_series.hpp"
#include "render/page/series.hpp"

namespace aims {
namespace {

using Eigen::Vector3f;
/// Rows of one scan in scans.csv.
struct Rows {
  double stamp = 0.0;  ///< [s]
  double returns = 0.0;
  std::size_t begin = 0;
  std::size_t end = 0;
};

std::vector<Rows> scans_in(const Numbers& stamps, const Numbers& returns) {
  std::vector<Rows> scans;
  for (std::size_t i = 0; i < stamps.size(); ++i) {
    if (scans.empty() || stamps[i] != scans.back().stamp) {
      scans.push_back({stamps[i], returns[i], i, i});
    }
    scans.back().end = i + 1;
  }
  return scans;
}

/// How far the body's origin is above the floor, where no scene shows the floor [m].
constexpr double kBodyHeight = 0.3;

/// The body at an instant: by the truth, else by the first estimate that has it.
std::optional<Pose> body_at(const RunFolder& run, Time stamp) {
  auto pose = pose_at(run.truth, stamp);
  for (const EstimatorFiles& each : run.estimators) {
    if (pose || !run.truth.empty()) break;
    pose = pose_at(each.trajectory, stamp);
  }
  return pose;
}

/// For each point whether it is below the ceiling. `scene`: null when it is not known.
std::vector<bool> below_ceiling(const std::vector<Vector3f>& points, const Pose& T_world_body,
                                const Scene* scene) {
  std::vector<bool> below(points.size(), true);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector3d p = T_world_body * points[i].cast<double>();
    const double floor = scene != nullptr ? floor_height(scene->floor, p.x(), p.y())
                                          : T_world_body.translation.z() - kBodyHeight;
    below[i] = p.z() <= floor + kCeilingCut;
  }
  return below;
}

}  // namespace

Result<Json> scans_json(const RunFolder& run, const Scene* scene, bool roofed, double start,
                        PageData& page) {
  if (!run.scans || run.scans->rows() == 0) return Json();
  std::vector<Numbers> columns;
  for (const char* name : {"stamp_s", "returns", "x", "y", "z", "intensity"}) {
    auto column = run.scans->numbers(name);
    if (!column) return tl::unexpected(column.error());
    column->resize(run.scans->rows(), std::nan(""));
    columns.push_back(std::move(*column));
  }
  std::array<Numbers, 4> lists;  // t, first, returns, below
  Numbers places;
  std::vector<std::uint8_t> intensities;
  for (const Rows& rows : scans_in(columns[0], columns[1])) {
    std::vector<Vector3f> points;
    for (std::size_t i = rows.begin; i < rows.end; ++i) {
      points.push_back(Eigen::Vector3d(columns[2][i], columns[3][i], columns[4][i]).cast<float>());
    }
    const auto pose = roofed ? body_at(run, from_seconds(rows.stamp)) : std::nullopt;
    const auto below =
        pose ? below_ceiling(points, *pose, scene) : std::vector<bool>(points.size(), true);
    lists[0].push_back(rows.stamp - start);
    lists[1].push_back(static_cast<double>(places.size() / 3));
    lists[2].push_back(rows.returns);
    lists[3].push_back(static_cast<double>(std::count(below.begin(), below.end(), true)));
    for (const std::size_t i : ordered_in_space(points, below)) {
      append(points[i].cast<double>(), places);
      const double intensity = std::clamp(columns[5][rows.begin + i], 0.0, 1.0);
      intensities.push_back(
          static_cast<std::uint8_t>(std::isnan(intensity) ? 0 : std::lround(255.0 * intensity)));
    }
  }
  return Json{{"t", page.f32(lists[0])},
              {"first", page.f32(lists[1])},
              {"returns", page.f32(lists[2])},
              {"below", page.f32(lists[3])},
              {"p", page.q16(places, 3, {.least_step = kMapStep, .relative = 0.0})},
              {"intensity", page.u8(intensities)}};
}

}  // namespace aims
