// SPDX-License-Identifier: BSD-3-Clause
#include "bench/metrics/consistency.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

#include "bench/metrics/statistics.hpp"

namespace aims {
namespace {

constexpr double kTail = 0.025;  ///< outside either end of the 95 % bounds
constexpr double kSigmas = 2.0;  ///< of the coverage
constexpr std::uint64_t kBootstrapSeed = 1;

bool is_stated(const ConsistencySample& sample) { return sample.sigma_m && *sample.sigma_m > 0.0; }

double nees_of(const ConsistencySample& sample) {
  return sample.error_m * sample.error_m / (*sample.sigma_m * *sample.sigma_m);
}

bool is_covered(const ConsistencySample& sample) {
  return std::abs(sample.error_m) <= kSigmas * *sample.sigma_m;
}

/// Sums over samples of which root mean squares are made.
struct Squares {
  int count = 0;
  int stated = 0;
  int covered = 0;
  double nees = 0.0;
  double error = 0.0;
  double sigma = 0.0;
  double bound = 0.0;
  double leg_bound = 0.0;

  void add(const ConsistencySample& sample) {
    ++count;
    error += sample.error_m * sample.error_m;
    bound += sample.bound_m * sample.bound_m;
    leg_bound += sample.leg_bound_m * sample.leg_bound_m;
    if (!is_stated(sample)) return;
    ++stated;
    covered += is_covered(sample);
    nees += nees_of(sample);
    sigma += *sample.sigma_m * *sample.sigma_m;
  }

  std::optional<double> mean_nees() const {
    return stated > 0 ? std::optional(nees / stated) : std::nullopt;
  }
  std::optional<double> efficiency() const {
    return error > 0.0 ? std::optional(std::sqrt(bound / error)) : std::nullopt;
  }
};

double root_mean(double squares, int count) { return count > 0 ? std::sqrt(squares / count) : 0.0; }

ConsistencyInstant instant_of(double time_s, const Squares& sums) {
  ConsistencyInstant instant;
  instant.time_s = time_s;
  instant.covered = coverage_of(sums.covered, sums.stated, true);
  instant.nees = sums.mean_nees();
  instant.bounds = mean_nees_bounds(sums.stated);
  instant.error_rms_m = root_mean(sums.error, sums.count);
  if (sums.stated > 0) instant.sigma_rms_m = root_mean(sums.sigma, sums.stated);
  instant.bound_rms_m = root_mean(sums.bound, sums.count);
  instant.leg_bound_rms_m = root_mean(sums.leg_bound, sums.count);
  instant.efficiency = sums.efficiency();
  return instant;
}

/// Fractions of the instants that at least half of the runs reach.
void judge_instants(Consistency& result) {
  int inside = 0;
  int above = 0;
  for (const ConsistencyInstant& instant : result.instants) {
    if (instant.covered.runs < 2 || 2 * instant.covered.runs < result.runs) continue;
    ++result.judged;
    inside += instant.inside();
    above += instant.above();
  }
  if (result.judged == 0) return;
  result.inside_fraction = static_cast<double>(inside) / result.judged;
  result.above_fraction = static_cast<double>(above) / result.judged;
}

/// All samples, and the mean over runs of the means over time.
void judge_all(std::span<const ConsistencyRun> runs, Consistency& result) {
  Squares all;
  std::vector<double> means;
  for (const ConsistencyRun& run : runs) {
    Squares own;
    for (const ConsistencySample& sample : run) {
      own.add(sample);
      all.add(sample);
    }
    if (const auto nees = own.mean_nees()) means.push_back(*nees);
  }
  result.mean_nees = mean(means);
  result.mean_nees_interval = bootstrap_interval(
      means.size(),
      [&means](std::span<const std::size_t> picked) {
        std::vector<double> drawn;
        for (const std::size_t i : picked) drawn.push_back(means[i]);
        return mean(drawn);
      },
      kBootstrapSeed);
  result.two_sigma = coverage_of(all.covered, all.stated, false);
  result.error_rms_m = root_mean(all.error, all.count);
  result.efficiency = all.efficiency();
}

}  // namespace

Interval mean_nees_bounds(int runs) {
  if (runs <= 0) return {};
  const auto dof = static_cast<double>(runs);
  return {chi_square_quantile(kTail, dof) / dof, chi_square_quantile(1.0 - kTail, dof) / dof};
}

Coverage coverage_of(int inside, int runs, bool independent) {
  Coverage coverage{inside, runs, std::nullopt, {}};
  if (runs == 0) return coverage;
  coverage.fraction = static_cast<double>(inside) / runs;
  if (!independent) return coverage;
  coverage.interval =
      wilson_interval(static_cast<std::size_t>(inside), static_cast<std::size_t>(runs));
  return coverage;
}

Consistency consistency_of(std::span<const ConsistencyRun> runs) {
  Consistency result;
  std::map<double, Squares> by_time;
  Squares ends;
  for (const ConsistencyRun& run : runs) {
    for (const ConsistencySample& sample : run) by_time[sample.time_s].add(sample);
    if (!run.empty()) ends.add(run.back());
  }
  result.runs = ends.count;
  for (const auto& [time_s, sums] : by_time) result.instants.push_back(instant_of(time_s, sums));
  result.end = instant_of(by_time.empty() ? 0.0 : by_time.rbegin()->first, ends);
  judge_instants(result);
  judge_all(runs, result);
  return result;
}

}  // namespace aims
