// SPDX-License-Identifier: BSD-3-Clause
#include "bench/metrics/consistency.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "bench/metrics/statistics.hpp"
#include "core/random.hpp"

namespace aims {
namespace {

constexpr int kInstants = 200;

/// Runs of a filter whose error is a stationary Gauss-Markov process of deviation 0.1 m, and which
/// states `stated` times that.
std::vector<ConsistencyRun> synthetic_runs(int count, double stated, double bound = 0.05) {
  std::vector<ConsistencyRun> runs;
  for (int seed = 1; seed <= count; ++seed) {
    auto random = rng(static_cast<std::uint64_t>(seed), "consistency.test");
    ConsistencyRun run;
    double error = 0.1 * random.normal();
    for (int t = 0; t < kInstants; ++t) {
      run.push_back({static_cast<double>(t), error, stated * 0.1, bound, 1.0});
      error = 0.9 * error + std::sqrt(1.0 - 0.81) * 0.1 * random.normal();
    }
    runs.push_back(std::move(run));
  }
  return runs;
}

TEST(ChiSquare, QuantilesAreThoseOfTheTables) {
  EXPECT_NEAR(chi_square_quantile(0.95, 1.0), 3.841458821, 1e-8);
  EXPECT_NEAR(chi_square_quantile(0.025, 1.0), 0.000982069117, 1e-10);
  EXPECT_NEAR(chi_square_quantile(0.975, 50.0), 71.42019518, 1e-6);
  EXPECT_NEAR(chi_square_quantile(0.025, 50.0), 32.35736370, 1e-6);
  EXPECT_NEAR(chi_square_quantile(0.95, 6.0), 12.59158724, 1e-7);
}

TEST(Consistency, OfAConsistentFilterLiesInsideTheBoundsAtNineteenInstantsOfTwenty) {
  const Consistency result = consistency_of(synthetic_runs(50, 1.0));
  ASSERT_EQ(result.judged, kInstants);
  EXPECT_NEAR(*result.inside_fraction, 0.95, 0.04);
  EXPECT_NEAR(*result.mean_nees, 1.0, 0.1);
  EXPECT_NEAR(*result.two_sigma.fraction, 0.9545, 0.015);
  EXPECT_TRUE(*result.mean_nees_interval.low < 1.0 && 1.0 < *result.mean_nees_interval.high);
}

TEST(Consistency, OfAFilterThatStatesHalfItsErrorLiesAboveTheBounds) {
  const Consistency result = consistency_of(synthetic_runs(50, 0.5));
  EXPECT_LT(*result.inside_fraction, 0.05);
  EXPECT_GT(*result.above_fraction, 0.95);
  EXPECT_NEAR(*result.mean_nees, 4.0, 0.4);
  EXPECT_NEAR(*result.two_sigma.fraction, 0.6827, 0.03);
  EXPECT_LT(*result.end.covered.interval.high, 0.95);
}

TEST(Consistency, OfAFilterThatStatesTwiceItsErrorLiesBelowTheBounds) {
  const Consistency result = consistency_of(synthetic_runs(50, 2.0));
  EXPECT_LT(*result.inside_fraction, 0.05);
  EXPECT_EQ(*result.above_fraction, 0.0);
  EXPECT_NEAR(*result.mean_nees, 0.25, 0.03);
  EXPECT_GE(*result.end.covered.fraction, 0.98);
}

TEST(Consistency, BoundsOfTheMeanAreChiSquareOverItsDegreesOfFreedom) {
  const Interval bounds = mean_nees_bounds(50);
  EXPECT_NEAR(*bounds.low, 32.3573637 / 50.0, 1e-6);
  EXPECT_NEAR(*bounds.high, 71.4201952 / 50.0, 1e-6);
  EXPECT_FALSE(mean_nees_bounds(0).low);
}

TEST(Consistency, EfficiencyIsTheBoundOverTheErrorBothRootMeanSquare) {
  const std::vector<ConsistencyRun> runs = {{{0.0, 0.3, 0.1, 0.1, 0.5}, {1.0, -0.6, 0.3, 0.2, 0.4}},
                                            {{0.0, 0.1, 0.1, 0.1, 0.5}, {1.0, 0.8, 0.3, 0.2, 0.4}}};
  const Consistency result = consistency_of(runs);
  EXPECT_NEAR(result.error_rms_m, std::sqrt((0.09 + 0.36 + 0.01 + 0.64) / 4.0), 1e-12);
  EXPECT_NEAR(*result.efficiency, std::sqrt(0.1 / 1.1), 1e-12);
  EXPECT_NEAR(result.end.error_rms_m, std::sqrt(0.5), 1e-12);
  EXPECT_NEAR(result.end.sigma_rms_m.value(), 0.3, 1e-12);
  EXPECT_NEAR(result.end.leg_bound_rms_m, 0.4, 1e-12);
  EXPECT_NEAR(*result.end.efficiency, 0.2 / std::sqrt(0.5), 1e-12);
  EXPECT_NEAR(*result.end.nees, 0.5 * (4.0 + 64.0 / 9.0), 1e-12);
  EXPECT_EQ(result.end.covered.inside, 1);
}

TEST(Consistency, CoverageCarriesTheWilsonInterval) {
  const Coverage coverage = coverage_of(48, 50, true);
  EXPECT_DOUBLE_EQ(*coverage.fraction, 0.96);
  EXPECT_NEAR(*coverage.interval.low, 0.8654, 5e-4);
  EXPECT_NEAR(*coverage.interval.high, 0.9890, 5e-4);
  EXPECT_FALSE(coverage_of(0, 0, true).fraction);
  EXPECT_FALSE(coverage_of(3, 4, false).interval.low);
}

TEST(Consistency, JudgesAnInstantByTheRunsThatStateACovarianceThere) {
  std::vector<ConsistencyRun> runs = synthetic_runs(4, 1.0);
  runs[0].resize(50);                                   // a walk that ends early
  runs[1].erase(runs[1].begin());                       // a second without a scan
  for (auto& sample : runs[2]) sample.sigma_m.reset();  // states nothing
  const Consistency result = consistency_of(runs);
  EXPECT_EQ(result.instants[0].covered.runs, 2);
  EXPECT_EQ(result.instants[1].covered.runs, 3);
  EXPECT_EQ(result.instants[60].covered.runs, 2);
  EXPECT_EQ(result.end.covered.runs, 3);
  const double expected = std::pow(runs[3][0].error_m, 2) + std::pow(runs[0][0].error_m, 2);
  EXPECT_NEAR(*result.instants[0].nees, expected / 2.0 / 0.01, 1e-9);
}

TEST(Consistency, OfRunsThatStateNoCovarianceHasNoStatedDeviation) {
  std::vector<ConsistencyRun> runs = synthetic_runs(2, 1.0);
  for (auto& sample : runs[0]) sample.sigma_m.reset();
  EXPECT_EQ(consistency_of(runs).end.sigma_rms_m, runs[1].back().sigma_m) << "of those that do";
  for (auto& sample : runs[1]) sample.sigma_m.reset();
  EXPECT_FALSE(consistency_of(runs).end.sigma_rms_m);
}

TEST(Consistency, OfNoRunsIsNoVerdict) {
  const Consistency result = consistency_of({});
  EXPECT_EQ(result.judged, 0);
  EXPECT_FALSE(result.inside_fraction);
  EXPECT_FALSE(result.mean_nees);
  EXPECT_FALSE(result.end.covered.fraction);
}

}  // namespace
}  // namespace aims
