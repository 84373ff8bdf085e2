// SPDX-License-Identifier: BSD-3-Clause
#include "bench/tuning/optimizer.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

namespace aims {
namespace {

using Function = std::function<std::vector<double>(const std::vector<double>&)>;

BatchFunction batch_of(const Function& function, std::vector<std::size_t>* sizes = nullptr) {
  return [=](const Points& points) -> Result<std::optional<Points>> {
    if (sizes != nullptr) sizes->push_back(points.size());
    Points values;
    for (const auto& point : points) values.push_back(function(point));
    return values;
  };
}

/// A narrow, turned bowl with its least value at 0.6, 0.7, 0.8, ...
std::vector<double> bowl(const std::vector<double>& x) {
  double sum = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    sum += std::pow(x[i] - 0.6 - 0.1 * double(i), 2) * (1.0 + 9.0 * double(i));
  }
  return {sum + 5.0 * std::pow(x[0] - x[1] + 0.1, 2)};
}

/// Two bowls; the front lies between their centres, at x1 = 0.5.
std::vector<double> two_bowls(const std::vector<double>& x) {
  const double off = std::pow(x[1] - 0.5, 2);
  return {std::pow(x[0] - 0.2, 2) + off, std::pow(x[0] - 0.8, 2) + off};
}

std::size_t best_of(const OptimizerRun& run) {
  return static_cast<std::size_t>(std::min_element(run.objectives.begin(), run.objectives.end()) -
                                  run.objectives.begin());
}

TEST(Optimizer, FindsTheLeastOfABowl) {
  for (const OptimizerKind kind : {OptimizerKind::kAuto, OptimizerKind::kDe}) {
    OptimizerOptions options{.kind = kind, .generations = 60, .population = 12, .seed = 3};
    const auto run = minimize(batch_of(bowl), {0.1, 0.2, 0.3}, 1, options);
    ASSERT_TRUE(run) << run.error().message;
    const auto& best = run->points[best_of(*run)];
    for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(best[i], 0.6 + 0.1 * double(i), 0.03);
  }
}

TEST(Optimizer, FindsALeastThatLiesOnABorder) {
  OptimizerOptions options{.generations = 40, .population = 10, .seed = 1};
  const auto run =
      minimize(batch_of([](const std::vector<double>& x) { return std::vector{x[0] - x[1]}; }),
               {0.5, 0.5}, 1, options);
  ASSERT_TRUE(run);
  EXPECT_LT(run->objectives[best_of(*run)][0], -0.95);
  for (const auto& point : run->points) {
    for (const double x : point) {
      EXPECT_GE(x, 0.0);
      EXPECT_LE(x, 1.0);
    }
  }
}

TEST(Optimizer, SameSeedAsksForTheSamePoints) {
  for (const OptimizerKind kind :
       {OptimizerKind::kCmaes, OptimizerKind::kDe, OptimizerKind::kNsga2}) {
    const bool two = kind == OptimizerKind::kNsga2;
    const auto run = [&](int seed) {
      OptimizerOptions options{.kind = kind, .generations = 6, .population = 8, .seed = seed};
      return minimize(batch_of(two ? two_bowls : bowl), {0.1, 0.2}, two ? 2 : 1, options)->points;
    };
    EXPECT_EQ(run(7), run(7));
    EXPECT_NE(run(7), run(8));
  }
}

TEST(Optimizer, AsksForAGenerationAtOnceAndNothingTwice) {
  for (const OptimizerKind kind :
       {OptimizerKind::kCmaes, OptimizerKind::kDe, OptimizerKind::kNsga2}) {
    const bool two = kind == OptimizerKind::kNsga2;
    std::vector<std::size_t> sizes;
    OptimizerOptions options{.kind = kind, .generations = 10, .population = 12};
    const auto run =
        minimize(batch_of(two ? two_bowls : bowl, &sizes), {0.1, 0.2}, two ? 2 : 1, options);
    ASSERT_TRUE(run);
    EXPECT_EQ(sizes.size(), 11U);
    for (const std::size_t size : sizes) EXPECT_LE(size, 12U);
    auto sorted = run->points;
    std::sort(sorted.begin(), sorted.end());
    EXPECT_EQ(std::adjacent_find(sorted.begin(), sorted.end()), sorted.end());
    EXPECT_EQ(run->points.front(), (std::vector<double>{0.1, 0.2}));
    EXPECT_EQ(run->generation.back(), 10);
  }
}

TEST(Optimizer, SpreadsAFrontOverTwoObjectives) {
  OptimizerOptions options{.generations = 40, .population = 24, .seed = 1};
  const auto run = minimize(batch_of(two_bowls), {0.5, 0.1}, 2, options);
  ASSERT_TRUE(run) << run.error().message;
  const auto front = pareto_front(run->objectives);
  ASSERT_GT(front.size(), 10U);
  EXPECT_NEAR(run->points[front.front()][0], 0.2, 0.05);
  EXPECT_NEAR(run->points[front.back()][0], 0.8, 0.05);
  for (const std::size_t k : front) EXPECT_NEAR(run->points[k][1], 0.5, 0.1);
}

TEST(Optimizer, StopsWhereThereIsNothingLeftToTell) {
  OptimizerOptions options{.generations = 500, .population = 10};
  const auto run = minimize(batch_of(bowl), {0.1, 0.2}, 1, options);
  ASSERT_TRUE(run);
  EXPECT_TRUE(run->converged);
  EXPECT_LT(run->generation.back(), 300);
}

TEST(Optimizer, KeepsWhatItHasWhenItIsEnded) {
  int calls = 0;
  const BatchFunction function = [&](const Points& points) -> Result<std::optional<Points>> {
    if (++calls == 4) return std::optional<Points>();
    return batch_of(bowl)(points);
  };
  const auto run = minimize(function, {0.1, 0.2}, 1, {});
  ASSERT_TRUE(run);
  EXPECT_FALSE(run->complete);
  EXPECT_EQ(run->generation.back(), 2);
  const auto failed =
      minimize([](const Points&) -> Result<std::optional<Points>> { return failure("disk full"); },
               {0.5}, 1, {});
  ASSERT_FALSE(failed);
  EXPECT_EQ(failed.error().message, "disk full");
}

TEST(Optimizer, RefusesWhatDoesNotFit) {
  EXPECT_FALSE(check_optimizer({.population = 4}, 1));
  EXPECT_FALSE(check_optimizer({.kind = OptimizerKind::kCmaes, .population = 8}, 2));
  EXPECT_FALSE(check_optimizer({.kind = OptimizerKind::kNsga2, .population = 8}, 1));
  EXPECT_FALSE(check_optimizer({.population = 10}, 2));
  EXPECT_TRUE(check_optimizer({.population = 12}, 2));
  EXPECT_FALSE(check_optimizer({}, 0));
}

TEST(ParetoFront, HoldsWhatNothingBeats) {
  const Points objectives = {{3, 1}, {1, 3}, {2, 2}, {3, 3}, {2, 2}, {1, 4}};
  EXPECT_EQ(pareto_front(objectives), (std::vector<std::size_t>{1, 2, 0}));
  EXPECT_TRUE(pareto_front({}).empty());
}

}  // namespace
}  // namespace aims
