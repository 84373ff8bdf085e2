// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string_view>
#include <vector>

#include "core/error.hpp"
#include "tests/independent/world.hpp"

namespace aims::independent {

/// A place and how far the LiDAR sees in it.
struct Cell {
  World world;
  double length = 78.6;       ///< of the route, one way, from the origin along +x [m]
  double range_limit = 30.0;  ///< of the LiDAR [m]
};

/// Names: doors_100, doors_30, recess5_30, recess2_30, plain_100, plain_30, plain_open_30,
/// garage_30.
std::vector<std::string_view> cell_names();

/// The cell of that name with a route of `length` [m]; 0: its own. Error for an unknown name.
Result<Cell> make_cell(std::string_view name, double length = 0.0);

}  // namespace aims::independent
