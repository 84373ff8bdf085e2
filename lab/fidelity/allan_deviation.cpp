// SPDX-License-Identifier: BSD-3-Clause
#include "lab/fidelity/allan_deviation.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "bench/metrics/statistics.hpp"

namespace aims {
namespace {

/// Integral of the series, its mean removed for the sake of rounding: a constant has no effect.
std::vector<double> integral(std::span<const double> series, double rate) {
  const double average = mean(series).value_or(0.0);
  std::vector<double> sums = {0.0};
  sums.reserve(series.size() + 1);
  for (const double value : series) sums.push_back(sums.back() + (value - average) / rate);
  return sums;
}

}  // namespace

std::vector<AllanPoint> allan_deviation(std::span<const double> series, double rate,
                                        std::span<const double> averaging_times) {
  const std::vector<double> theta = integral(series, rate);
  std::vector<AllanPoint> points;
  for (const double wanted : averaging_times) {
    const double samples = std::max(1.0, std::round(wanted * rate));
    if (!(2.0 * samples <= static_cast<double>(series.size()))) continue;
    const auto m = static_cast<std::size_t>(samples);
    const double tau = samples / rate;
    double sum = 0.0;
    const std::size_t count = theta.size() - 2 * m;
    for (std::size_t k = 0; k < count; ++k) {
      const double difference = theta[k + 2 * m] - 2.0 * theta[k + m] + theta[k];
      sum += difference * difference;
    }
    points.push_back({tau, std::sqrt(sum / (2.0 * tau * tau * static_cast<double>(count)))});
  }
  return points;
}

}  // namespace aims
