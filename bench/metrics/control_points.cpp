// SPDX-License-Identifier: BSD-3-Clause
#include "bench/metrics/control_points.hpp"

#include <algorithm>
#include <array>

#include "bench/metrics/absolute_error.hpp"

namespace aims {
namespace {

struct Class {
  double below;  ///< position error [m]
  int earned;
};

constexpr std::array<Class, 4> kClasses = {{{0.01, 10}, {0.03, 6}, {0.06, 3}, {0.10, 1}}};
constexpr int kMost = 10;  ///< earned by one point

}  // namespace

double control_point_score(std::span<const PosePair> aligned, int points) {
  if (points <= 0) return 0.0;
  int sum = 0;
  for (const double error : position_errors(aligned)) {
    const auto* found =
        std::ranges::find_if(kClasses, [error](const Class& each) { return error < each.below; });
    if (found != kClasses.end()) sum += found->earned;
  }
  return 100.0 * sum / (kMost * points);
}

}  // namespace aims
