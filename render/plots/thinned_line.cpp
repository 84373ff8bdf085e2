// SPDX-License-Identifier: BSD-3-Clause
#include "render/plots/thinned_line.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace aims {
namespace {

constexpr std::size_t kShownWhole = 20'000;
constexpr double kRunsPerPixel = 4.0;

/// The end of the run that begins at `begin`; a point that is not finite is a run of its own.
std::size_t run_end(const std::vector<Eigen::Vector2d>& points, std::size_t begin) {
  std::size_t end = begin + 1;
  if (!points[begin].allFinite()) return end;
  const double place = std::floor(kRunsPerPixel * points[begin].x());
  while (end < points.size() && points[end].allFinite() &&
         std::floor(kRunsPerPixel * points[end].x()) == place) {
    ++end;
  }
  return end;
}

}  // namespace

std::vector<Eigen::Vector2d> thinned_line(std::vector<Eigen::Vector2d> points) {
  if (points.size() <= kShownWhole) return points;
  std::vector<Eigen::Vector2d> kept;
  const auto lower = [&](std::size_t a, std::size_t b) { return points[a].y() < points[b].y(); };
  for (std::size_t begin = 0; begin < points.size();) {
    const std::size_t end = run_end(points, begin);
    std::size_t lowest = begin, highest = begin;
    for (std::size_t i = begin + 1; i < end; ++i) {
      if (lower(i, lowest)) lowest = i;
      if (lower(highest, i)) highest = i;
    }
    std::array<std::size_t, 4> shown = {begin, lowest, highest, end - 1};
    std::ranges::sort(shown);
    for (std::size_t i = 0; i < shown.size(); ++i) {
      if (i == 0 || shown[i] != shown[i - 1]) kept.push_back(points[shown[i]]);
    }
    begin = end;
  }
  return kept;
}

}  // namespace aims
