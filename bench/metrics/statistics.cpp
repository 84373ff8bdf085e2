// SPDX-License-Identifier: BSD-3-Clause
#include "bench/metrics/statistics.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

namespace aims {
namespace {

double quantile_of_sorted(const std::vector<double>& sorted, double fraction) {
  const double position = std::clamp(fraction, 0.0, 1.0) * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(position);
  const std::size_t above = std::min(below + 1, sorted.size() - 1);
  return std::lerp(sorted[below], sorted[above], position - static_cast<double>(below));
}

std::vector<double> sorted_copy(std::span<const double> values) {
  std::vector<double> sorted(values.begin(), values.end());
  std::sort(sorted.begin(), sorted.end());
  return sorted;
}

}  // namespace

std::optional<double> mean(std::span<const double> values) {
  if (values.empty()) return std::nullopt;
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

std::optional<double> quantile(std::span<const double> values, double fraction) {
  if (values.empty()) return std::nullopt;
  return quantile_of_sorted(sorted_copy(values), fraction);
}

std::optional<double> median(std::span<const double> values) { return quantile(values, 0.5); }

std::optional<Summary> summarize(std::span<const double> values) {
  std::vector<double> finite;
  for (const double value : values) {
    if (std::isfinite(value)) finite.push_back(value);
  }
  if (finite.empty()) return std::nullopt;
  std::sort(finite.begin(), finite.end());
  return Summary{.count = static_cast<int>(finite.size()),
                 .missing = static_cast<int>(values.size() - finite.size()),
                 .mean = *mean(finite),
                 .p50 = quantile_of_sorted(finite, 0.5),
                 .p99 = quantile_of_sorted(finite, 0.99),
                 .worst = finite.back()};
}

}  // namespace aims
