// SPDX-License-Identifier: BSD-3-Clause
#include "bench/metrics/bootstrap.hpp"

#include <vector>

#include "bench/metrics/statistics.hpp"
#include "core/random.hpp"

namespace aims {

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

}  // namespace aims
