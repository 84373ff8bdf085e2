// SPDX-License-Identifier: BSD-3-Clause
#include "bench/metrics/control_points.hpp"

#include <algorithm>
#include <array>

namespace aims {
namespace {

struct Class {
  double below;  ///< position error [m]
  int earned;
};

constexpr std::array<Class, 4> kOf2022 = {{{0.01, 10}, {0.03, 6}, {0.06, 3}, {0.10, 1}}};
constexpr std::array<Class, 6> kOf2023 = {
    {{0.005, 20}, {0.01, 10}, {0.03, 6}, {0.06, 5}, {0.10, 3}, {0.40, 1}}};

/// Of what the first class earns for each point [%].
double score_by(std::span<const Class> classes, std::span<const double> errors, int points) {
  if (points <= 0) return 0.0;
  int sum = 0;
  for (const double error : errors) {
    const auto found =
        std::ranges::find_if(classes, [error](const Class& each) { return error < each.below; });
    if (found != classes.end()) sum += found->earned;
  }
  return 100.0 * sum / (classes.front().earned * points);
}

}  // namespace

double control_point_score(std::span<const double> errors, int points) {
  return score_by(kOf2022, errors, points);
}

double control_point_score_2023(std::span<const double> errors, int points) {
  return score_by(kOf2023, errors, points);
}

}  // namespace aims
