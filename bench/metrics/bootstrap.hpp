// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>

namespace aims {

/// Bounds of a confidence interval; both empty when the data do not determine it.
struct Interval {
  std::optional<double> low;
  std::optional<double> high;

  bool operator==(const Interval&) const = default;
};

/// A statistic of the clusters with these indices (one may occur several times); no value where it
/// has none.
using ClusterStatistic = std::function<std::optional<double>(std::span<const std::size_t>)>;

/// Percentile bootstrap interval (Efron and Tibshirani 1993, section 13.3) of a statistic over
/// independent clusters, e.g. runs: `replicates` times, as many clusters as given are drawn with
/// replacement from the stream rng(seed, "bootstrap"). Replicates without a value are left out; the
/// interval is empty for fewer than two clusters, or when no replicate has a value. With few
/// clusters it is too narrow: five cannot give more than 5^5 resamples.
Interval bootstrap_interval(std::size_t clusters, const ClusterStatistic& statistic,
                            std::uint64_t seed, int replicates = 1000, double confidence = 0.95);

}  // namespace aims
