// SPDX-License-Identifier: BSD-3-Clause
#include "tests/independent/cells.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace aims::independent {
namespace {

constexpr double kCorridorLength = 78.6;
constexpr double kGarageLength = 55.0;
constexpr double kBeyond = 3.0;        ///< from the route's ends to the end walls [m]
constexpr double kOpenBeyond = 500.0;  ///< farther than any range limit [m]
constexpr double kDoorSpacing = 8.0;

struct CellRow {
  std::string_view name;
  double recess_depth;  ///< of the doors on the left; 0: none [m]
  bool open_ends;
  double range_limit;  ///< [m]
};

constexpr CellRow kCorridors[] = {
    {"doors_100", 0.15, false, 100.0},  {"doors_30", 0.15, false, 30.0},
    {"recess5_30", 0.05, false, 30.0},  {"recess2_30", 0.02, false, 30.0},
    {"plain_100", 0.0, false, 100.0},   {"plain_30", 0.0, false, 30.0},
    {"plain_open_30", 0.0, true, 30.0},
};
constexpr std::string_view kGarage = "garage_30";

Box box(double x0, double x1, double y0, double y1, double z0, double z1) {
  return {Eigen::Vector3d(x0, y0, z0), Eigen::Vector3d(x1, y1, z1)};
}

/// 2.2 x 2.6 m; doors of 1 x 2.1 m every 8 m.
World corridor(const CellRow& row, double length) {
  const double beyond = row.open_ends ? kOpenBeyond : kBeyond;
  World world{box(-beyond, length + beyond, -1.1, 1.1, 0.0, 2.6), {}, {}, {}};
  if (row.recess_depth == 0.0) return world;
  for (double x = 2.0; x + 1.0 < length + beyond; x += kDoorSpacing) {
    world.recesses.push_back(box(x, x + 1.0, 1.1, 1.1 + row.recess_depth, 0.0, 2.1));
  }
  return world;
}

/// 16 x 3 m, with pillars along the aisle and parked cars behind them; some places are free.
World garage(double length) {
  World world{box(-2.5, length + 2.5, -8.0, 8.0, 0.0, 3.0), {}, {}, {}};
  for (double x = 0.5; x < length + 2.0; x += 7.5) {
    world.pillars.push_back({x, -2.9, 0.25});
    world.pillars.push_back({x + 1.0, 2.9, 0.3});
  }
  int place = 0;
  for (double x = 1.5; x + 1.8 < length + 2.0; x += 2.5, ++place) {
    if (place % 3 != 1) world.boxes.push_back(box(x, x + 1.8, -7.6, -3.4, 0.0, 1.45));
    if (place % 4 != 2) world.boxes.push_back(box(x + 0.3, x + 2.0, 3.5, 7.9, 0.0, 1.6));
  }
  return world;
}

}  // namespace

std::vector<std::string_view> cell_names() {
  std::vector<std::string_view> names;
  for (const CellRow& row : kCorridors) names.push_back(row.name);
  names.push_back(kGarage);
  return names;
}

Result<Cell> make_cell(std::string_view name, double length) {
  if (name == kGarage) {
    const double route = length > 0.0 ? length : kGarageLength;
    return Cell{garage(route), route, 30.0};
  }
  const auto* row = std::ranges::find(kCorridors, name, &CellRow::name);
  if (row == std::end(kCorridors)) {
    return failure(
        fmt::format("unknown cell '{}'; expected one of {}", name, fmt::join(cell_names(), ", ")));
  }
  const double route = length > 0.0 ? length : kCorridorLength;
  return Cell{corridor(*row, route), route, row->range_limit};
}

}  // namespace aims::independent
