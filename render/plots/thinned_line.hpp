// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <vector>

namespace aims {

/// A line of more points than a picture can show, without those that it would not show: of each run
/// of points within a quarter of a pixel along x, the first, the lowest, the highest and the last,
/// in their order. Points [pixels]; those that are not finite end a run, and stay. Lines of up to
/// 20,000 points stay as they are.
std::vector<Eigen::Vector2d> thinned_line(std::vector<Eigen::Vector2d> points);

}  // namespace aims
