// SPDX-License-Identifier: BSD-3-Clause
#include "bench/metrics/rank_correlation.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>

namespace aims {
namespace {

/// -1, 0 or 1; equal infinities are equal.
int order_of(double a, double b) { return (a > b) - (a < b); }

}  // namespace

std::optional<double> kendall_tau(std::span<const double> x, std::span<const double> y) {
  assert(x.size() == y.size());
  const auto is_nan = [](double value) { return std::isnan(value); };
  if (std::ranges::any_of(x, is_nan) || std::ranges::any_of(y, is_nan)) return std::nullopt;
  double sum = 0.0;  // concordant minus discordant pairs
  double untied_x = 0.0;
  double untied_y = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const int by_x = order_of(x[i], x[j]);
      const int by_y = order_of(y[i], y[j]);
      sum += by_x * by_y;
      untied_x += std::abs(by_x);
      untied_y += std::abs(by_y);
    }
  }
  if (untied_x == 0.0 || untied_y == 0.0) return std::nullopt;
  return sum / std::sqrt(untied_x * untied_y);
}

}  // namespace aims
