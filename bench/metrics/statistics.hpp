// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>

namespace aims {

/// Arithmetic mean; none of no values.
std::optional<double> mean(std::span<const double> values);

/// The value below which a `fraction` in [0, 1] of the values lies: linear between the two order
/// statistics around position fraction * (count - 1) (type 7 of Hyndman and Fan, as in numpy).
std::optional<double> quantile(std::span<const double> values, double fraction);

/// The 0.5 quantile.
std::optional<double> median(std::span<const double> values);

/// Summary of a sample of which more is worse (errors, times).
struct Summary {
  int count = 0;    ///< finite values, of which the rest is made
  int missing = 0;  ///< values that are not finite
  double mean = 0.0;
  double p50 = 0.0;  ///< median
  double p99 = 0.0;
  double worst = 0.0;  ///< largest
};

/// Summary of the finite values; none when there is none.
std::optional<Summary> summarize(std::span<const double> values);

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

/// 95 % interval of a probability of which `count` of `trials` independent trials came true (Wilson
/// 1927, without continuity correction); in [0, 1], empty without trials.
Interval wilson_interval(std::size_t count, std::size_t trials);

/// Successes of two on the same sequences, where one alone has one.
struct McNemarTest {
  std::size_t only_first = 0;
  std::size_t only_second = 0;
  double p = 1.0;  ///< two-sided
};

/// McNemar's test in its exact form: where both are equally good, either is as likely to be the one
/// that succeeds alone, so that the smaller count is binomial with probability 1/2 (McNemar 1947;
/// Fagerland, Lydersen and Laake 2013, eq. 4).
McNemarTest mcnemar_test(std::size_t only_first, std::size_t only_second);

/// Probability that this test gives p <= 0.05 on so many sequences with one success when both are
/// equally good; below 0.05, and zero for fewer than six.
double mcnemar_false_alarm(std::size_t discordant);

/// Kendall's rank correlation of pairs (x_i, y_i), in [-1, 1]: 1 where both put them in the same
/// order, -1 where in the opposite one. Form tau-b, which corrects for ties (Kendall 1945). An
/// infinite value is larger than any other and tied with its like. None when all x or all y are
/// tied, below two pairs, or when a value is NaN. Both have the same length.
std::optional<double> kendall_tau(std::span<const double> x, std::span<const double> y);

/// The value that a chi-square variable of `dof` > 0 degrees of freedom stays below with
/// `probability` in (0, 1).
double chi_square_quantile(double probability, double dof);

}  // namespace aims
