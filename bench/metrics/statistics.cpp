// SPDX-License-Identifier: BSD-3-Clause
#include "bench/metrics/statistics.hpp"

#include <boost/math/distributions/chi_squared.hpp>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>
#include <vector>

#include "core/random.hpp"

namespace aims {

namespace {

constexpr double kNormalQuantile = 1.959963984540054;  ///< of 97.5 %
constexpr double kLevel = 0.05;

/// Probability of `count` heads in `trials` throws of a coin.
double coin_probability(std::size_t count, std::size_t trials) {
  const auto k = static_cast<double>(count);
  const auto n = static_cast<double>(trials);
  return std::exp(std::lgamma(n + 1.0) - std::lgamma(k + 1.0) - std::lgamma(n - k + 1.0) -
                  n * std::log(2.0));
}

}  // namespace

Interval wilson_interval(std::size_t count, std::size_t trials) {
  if (trials == 0) return {};
  const auto n = static_cast<double>(trials);
  const double fraction = static_cast<double>(count) / n;
  const double z2 = kNormalQuantile * kNormalQuantile;
  const double middle = (fraction + z2 / (2.0 * n)) / (1.0 + z2 / n);
  const double half = kNormalQuantile / (1.0 + z2 / n) *
                      std::sqrt(fraction * (1.0 - fraction) / n + z2 / (4.0 * n * n));
  return {std::max(0.0, middle - half), std::min(1.0, middle + half)};
}

McNemarTest mcnemar_test(std::size_t only_first, std::size_t only_second) {
  const std::size_t discordant = only_first + only_second;
  double tail = 0.0;
  for (std::size_t k = 0; k <= std::min(only_first, only_second); ++k) {
    tail += coin_probability(k, discordant);
  }
  return {only_first, only_second, std::min(1.0, 2.0 * tail)};
}

double mcnemar_false_alarm(std::size_t discordant) {
  double probability = 0.0;
  double tail = 0.0;
  for (std::size_t k = 0; 2 * k < discordant; ++k) {
    tail += coin_probability(k, discordant);
    if (2.0 * tail > kLevel) break;
    probability = 2.0 * tail;
  }
  return probability;
}

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

double chi_square_quantile(double probability, double dof) {
  assert(probability > 0.0 && probability < 1.0);
  return boost::math::quantile(boost::math::chi_squared(dof), probability);
}

Interval bootstrap_interval(std::size_t clusters, const ClusterStatistic& statistic,
                            std::uint64_t seed, int replicates, double confidence) {
  if (clusters < 2) return {};
  RandomStream random = rng(seed, "bootstrap");
  std::vector<double> values;
  std::vector<std::size_t> drawn(clusters);
  for (int i = 0; i < replicates; ++i) {
    for (std::size_t& index : drawn) {
      index = static_cast<std::size_t>(random.uniform() * static_cast<double>(clusters));
    }
    if (const auto value = statistic(drawn)) values.push_back(*value);
  }
  const double tail = 0.5 * (1.0 - confidence);
  return {quantile(values, tail), quantile(values, 1.0 - tail)};
}

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
