// SPDX-License-Identifier: BSD-3-Clause
#include "bench/metrics/proportion.hpp"

#include <algorithm>
#include <cmath>

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

}  // namespace aims
