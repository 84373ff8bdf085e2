// SPDX-License-Identifier: BSD-3-Clause
#include "bench/tuning/analysis.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "bench/tuning/effect.hpp"
#include "bench/tuning/response_summary.hpp"
#include "bench/tuning/sensitivity.hpp"
#include "bench/tuning/slice.hpp"
#include "core/random.hpp"

namespace aims {
namespace {

/// Score of a point on a walk.
using Score = std::function<double(const std::vector<double>& point, const ResponseCase& on)>;

std::vector<ParameterRange> ranges_of(const std::vector<std::string>& texts) {
  std::vector<ParameterRange> ranges;
  for (const std::string& text : texts) ranges.push_back(parse_range(text).value());
  return ranges;
}

ResponseTable table_of(std::vector<ParameterRange> ranges, std::vector<double> defaults,
                       std::vector<std::vector<double>> points, int seeds, const Score& score) {
  ResponseTable table;
  table.ranges = std::move(ranges);
  table.defaults = std::move(defaults);
  table.points = std::move(points);
  for (const char* scenario : {"flat", "steep"}) {
    for (int seed = 1; seed <= seeds; ++seed) {
      table.cases.push_back({scenario, scenario, static_cast<std::uint64_t>(seed)});
    }
  }
  const auto runs_at = [&](const std::vector<double>& point) {
    std::vector<RunScore> runs;
    for (const ResponseCase& on : table.cases) runs.push_back({score(point, on), false});
    return runs;
  };
  for (const auto& point : table.points) table.runs.push_back(runs_at(point));
  table.default_runs = runs_at(table.defaults);
  return table;
}

/// Least at a = 2, b = 10, more so on "steep"; seeds scatter the scores a little.
double bowl(const std::vector<double>& point, const ResponseCase& on) {
  RandomStream random = rng(on.seed, "test." + on.scenario);
  const double steep = on.scenario == "steep" ? 3.0 : 1.0;
  const double shape =
      1.0 + steep * (std::pow(point[0] - 2.0, 2) / 4.0 + std::pow(std::log10(point[1]) - 1.0, 2));
  return shape * std::exp(0.1 * random.normal());
}

ResponseTable bowl_grid(int seeds) {
  auto ranges = ranges_of({"a=0:6:13", "b=log(1,100,5)"});
  auto points = design(DesignKind::kGrid, ranges, 0, 1);
  return table_of(ranges, {4.1, 30.0}, points, seeds, bowl);
}

Objective absolute() {
  Objective objective;
  objective.relative = false;
  return objective;
}

RunScore lost() { return {std::nullopt, true}; }

TEST(Objective, StatisticsAreThoseOfTheScores) {
  const std::vector<RunScore> runs = {{3.0, false}, {1.0, false}, {2.0, false}, {10.0, false}};
  Objective objective = absolute();
  EXPECT_DOUBLE_EQ(*objective_value(objective, runs, {}), 2.5);
  objective.statistic = ObjectiveStatistic::kMean;
  EXPECT_DOUBLE_EQ(*objective_value(objective, runs, {}), 4.0);
  objective.statistic = ObjectiveStatistic::kWorst;
  EXPECT_DOUBLE_EQ(*objective_value(objective, runs, {}), 10.0);
  objective.statistic = ObjectiveStatistic::kQuantile;
  objective.quantile = 1.0 / 3.0;
  EXPECT_DOUBLE_EQ(*objective_value(objective, runs, {}), 2.0);
}

TEST(Objective, EachLostRunMakesItWorse) {
  const Objective objective = absolute();
  std::vector<RunScore> runs(5, {1.0, false});
  double before = *objective_value(objective, runs, {});
  for (RunScore& run : runs) {
    run = lost();
    const double after = *objective_value(objective, runs, {});
    EXPECT_GT(after, before);
    before = after;
  }
  EXPECT_DOUBLE_EQ(before, 2.0 * objective.divergence_penalty);
}

TEST(Objective, ALostRunNeverCountsLessThanItsScore) {
  Objective objective = absolute();
  objective.statistic = ObjectiveStatistic::kWorst;
  EXPECT_DOUBLE_EQ(*objective_value(objective, std::vector<RunScore>{{70.0, true}}, {}), 80.0);
  EXPECT_DOUBLE_EQ(*objective_value(objective, std::vector<RunScore>{{0.1, true}}, {}), 20.0);
}

TEST(Objective, RelativeScoresAreHeldAgainstTheDefaultsOnTheSameWalk) {
  const Objective objective;
  const std::vector<RunScore> reference = {{0.1, false}, {4.0, false}, {1.0, false}};
  EXPECT_DOUBLE_EQ(*objective_value(objective, reference, reference), 1.0);
  const std::vector<RunScore> runs = {{0.05, false}, {2.0, false}, {0.5, false}};
  EXPECT_DOUBLE_EQ(*objective_value(objective, runs, reference), 0.5);
  EXPECT_FALSE(objective_value(objective, runs, {}));
}

TEST(Objective, WithoutScoresThereIsNone) {
  EXPECT_FALSE(objective_value(absolute(), {}, {}));
  EXPECT_FALSE(objective_value(absolute(), std::vector<RunScore>{{std::nullopt, false}}, {}));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(objective_value(absolute(), std::vector<RunScore>{{nan, false}}, {}));
}

TEST(BestPoint, IsTheLeastOfTheGridWithItsGainOverTheDefaults) {
  const ResponseTable table = bowl_grid(8);
  const auto best = best_point(table, absolute());
  ASSERT_TRUE(best);
  EXPECT_EQ(best->values, (std::vector<double>{2.0, 10.0}));
  EXPECT_NEAR(*best->gain, 1.0 - best->objective / *best->defaults, 1e-12);
  EXPECT_GT(*best->gain_interval.low, 0.3);
  EXPECT_LT(*best->objective_interval.low, best->objective);
  EXPECT_NEAR(best->distance[0], (2.0 - 4.1) / 6.0, 1e-9);
  EXPECT_NEAR(best->distance[1], (1.0 - std::log10(30.0)) / 2.0, 1e-9);
  for (std::size_t i = 0; i < 2; ++i) {  // no draw of seeds moves this least
    EXPECT_EQ(best->between[i].low, best->values[i]);
    EXPECT_EQ(best->between[i].high, best->values[i]);
  }
}

TEST(BestPoint, OfParametersThatSeedsDisagreeOnIsWide) {
  const auto ranges = ranges_of({"a=0:6:13"});
  const auto table = table_of(ranges, {3.0}, design(DesignKind::kGrid, ranges, 0, 1), 12,
                              [](const std::vector<double>& point, const ResponseCase& on) {
                                const double best = on.seed % 2 == 0 ? 1.0 : 5.0;
                                return 1.0 + std::abs(point[0] - best);
                              });
  Objective objective = absolute();
  objective.statistic = ObjectiveStatistic::kMean;
  const auto best = best_point(table, objective);
  ASSERT_TRUE(best);
  EXPECT_LE(*best->between[0].low, 1.0);
  EXPECT_GE(*best->between[0].high, 5.0);
}

TEST(BestPoint, OfOneSeedHasNoIntervals) {
  const auto best = best_point(bowl_grid(1), absolute());
  ASSERT_TRUE(best);
  EXPECT_EQ(best->gain_interval, Interval{});
  EXPECT_EQ(best->between[0], Interval{});
}

TEST(BestPoint, NeedsAScore) {
  ResponseTable table = bowl_grid(2);
  for (auto& runs : table.runs) runs.assign(runs.size(), {std::nullopt, false});
  const auto best = best_point(table, absolute());
  ASSERT_FALSE(best);
  EXPECT_NE(best.error().message.find("'ate_yaw_m'"), std::string::npos);
}

TEST(BestPoint, AreTheDefaultsWhereNoPointIsBetter) {
  const auto ranges = ranges_of({"a=0:6:4"});
  const auto table = table_of(ranges, {3.0}, design(DesignKind::kGrid, ranges, 0, 1), 3,
                              [](const std::vector<double>& point, const ResponseCase&) {
                                return 1.0 + 0.001 * std::abs(point[0] - 3.0);
                              });
  const auto best = best_point(table, absolute());
  ASSERT_TRUE(best);
  EXPECT_TRUE(best->is_default());
  EXPECT_EQ(best->values, table.defaults);
  const std::string text = response_markdown(table, absolute());
  EXPECT_NE(text.find("no point is better than the defaults: a 3 as by default"), std::string::npos)
      << text;
  EXPECT_EQ(text.find("Reduction"), std::string::npos) << text;
  EXPECT_NE(text.find("Keep the defaults: no point is better"), std::string::npos) << text;
  EXPECT_EQ(standing_of(*best, effect_of(table, absolute())), Standing::kKeepDefaults);
}

TEST(BestPoint, OfAThousandthLessIsNotAReductionByZero) {
  const auto ranges = ranges_of({"a=0:6:4"});
  const auto of = [&](double slope) {
    return table_of(ranges, {3.0}, design(DesignKind::kGrid, ranges, 0, 1), 1,
                    [=](const std::vector<double>& point, const ResponseCase&) {
                      return 1.0 + slope * point[0];
                    });
  };
  const std::string small = response_markdown(of(0.0001), absolute());
  EXPECT_NE(small.find("Reduction by less than 0.1 % on"), std::string::npos) << small;
  EXPECT_NE(small.find("No indices: one parameter was varied, without an effect that is resolved."),
            std::string::npos)
      << small;
  EXPECT_NE(response_markdown(of(0.5), absolute()).find("whose index is 100 % by definition"),
            std::string::npos);
}

TEST(Objective, OfATimeSaysThatItDependsOnTheMachine) {
  Objective objective = absolute();
  EXPECT_EQ(text_of(objective).find("machine"), std::string::npos);
  objective.score = "cpu_per_scan_ms";
  EXPECT_NE(text_of(objective).find("a time depends on the machine"), std::string::npos);
}

TEST(Objective, HasTheUnitOfItsScore) {
  Objective objective = absolute();
  const auto label_of = [&](const char* score) {
    objective.score = score;
    return value_label(objective);
  };
  EXPECT_EQ(label_of("drift_m.rmse.heading_rad"), "drift_m.rmse.heading_rad [rad]");
  EXPECT_EQ(label_of("optimized.ate_m"), "optimized.ate_m [m]");
  EXPECT_EQ(label_of("coverage"), "coverage");
}

TEST(Objective, OfAReoptimizedTrajectoryIsMinimizedAsThatOfTheOther) {
  EXPECT_FALSE(check_direction("it", "optimized.success"));
  EXPECT_TRUE(check_direction("it", "optimized.ate_m"));
}

TEST(BestPoint, KeepsTheDefaultOfAParameterWithoutEffect) {
  const auto ranges = ranges_of({"a=0:6:4", "inert=0:0.2:3"});
  const auto table = table_of(ranges, {3.0, 0.05}, design(DesignKind::kGrid, ranges, 0, 1), 3,
                              [](const std::vector<double>& point, const ResponseCase&) {
                                return 1.0 + std::abs(point[0] - 2.0);
                              });
  const auto best = best_point(table, absolute());
  ASSERT_TRUE(best);
  EXPECT_EQ(best->without_effect, (std::vector<bool>{false, true}));
  EXPECT_EQ(best->between[1], Interval{});
  const std::string text = response_markdown(table, absolute());
  EXPECT_NE(text.find("a 2 instead of 3, inert 0.05 as by default (no effect measured)"),
            std::string::npos)
      << text;
  EXPECT_NE(text.find("| no effect measured |"), std::string::npos) << text;
}

// b acts except where a is 0, and all pairs that differ in b alone are there.
TEST(Effect, OfAParameterIsNotDeniedByPairsAtOneValueOfAnother) {
  const auto ranges = ranges_of({"a=0:6:4", "b=0:1:4"});
  const std::vector<std::vector<double>> points = {{0, 0},   {0, 0.3}, {0, 0.7}, {0, 1},
                                                   {0, 0.5}, {3, 0.2}, {5, 0.9}, {6, 0.4}};
  const auto score = [](const std::vector<double>& point, const ResponseCase&) {
    return 1.0 + 0.1 * point[0] * point[1];
  };
  EXPECT_EQ(without_effect(table_of(ranges, {3.0, 0.5}, points, 3, score)),
            (std::vector<bool>{false, false}));
  const auto inert = [](const std::vector<double>& point, const ResponseCase&) {
    return 1.0 + 0.1 * point[0];
  };
  const std::vector<std::vector<double>> near = {{0, 0.5}, {0, 0.51}, {3, 0.5}, {3, 0.51},
                                                 {6, 0.5}, {6, 0.51}, {2, 0.0}, {4, 1.0}};
  EXPECT_EQ(without_effect(table_of(ranges, {3.0, 0.5}, near, 3, inert)),
            (std::vector<bool>{false, false}))
      << "pairs over 1 % of its range";
  EXPECT_EQ(without_effect(
                table_of(ranges, {3.0, 0.5}, design(DesignKind::kGrid, ranges, 0, 1), 3, inert)),
            (std::vector<bool>{false, true}));
}

// Draws would say 0.065 of an effect that is alike on six seeds.
TEST(Effect, OfFewArrangementsIsTestedExactly) {
  const auto ranges = ranges_of({"a=0:1:2"});
  const auto halved = table_of(ranges, {0.0}, {{0.0}, {1.0}}, 6,
                               [](const std::vector<double>& point, const ResponseCase& on) {
                                 return (point[0] == 1.0 ? 0.5 : 1.0) * double(1 + on.seed);
                               });
  const Effect effect = effect_of(halved, absolute());
  EXPECT_NEAR(*effect.p, 1.0 / 32.0, 1e-12);
  EXPECT_EQ(standing_of(*best_point(halved, absolute()), effect), Standing::kBest);
  const auto hardly = table_of(ranges, {0.0}, {{0.0}, {1.0}}, 6,
                               [](const std::vector<double>& point, const ResponseCase& on) {
                                 return (point[0] == 1.0 ? 0.998 : 1.0) * double(1 + on.seed);
                               });
  EXPECT_EQ(name_of(standing_of(*best_point(hardly, absolute()), effect_of(hardly, absolute()))),
            "least, too little to matter");
  EXPECT_NE(text_of(effect).find("all 32 arrangements"), std::string::npos) << text_of(effect);
}

TEST(BestPoint, SaysWhyItIsNotResolvedWherePointsDiffer) {
  const auto ranges = ranges_of({"a=0:5:6"});
  const auto table = table_of(ranges, {0.0}, {{1.0}, {2.0}, {3.0}, {4.0}, {5.0}}, 6,
                              [](const std::vector<double>& point, const ResponseCase& on) {
                                if (point[0] == 1.0) return on.seed % 2 == 0 ? 0.7 : 1.2;
                                return 1.0 + 2.0 * point[0] * (point[0] > 1.0 ? 1.0 : 0.0);
                              });
  const Effect effect = effect_of(table, absolute());
  const auto best = best_point(table, absolute());
  ASSERT_TRUE(best && effect.tells_best());
  EXPECT_EQ(standing_of(*best, effect), Standing::kUnresolved);
  EXPECT_NE(unresolved_text(*best, effect).find("points differ, but the gain over the defaults, "),
            std::string::npos)
      << unresolved_text(*best, effect);
}

TEST(Effect, OfASinglePointOrASmallOneIsSaidToBeThat) {
  const auto ranges = ranges_of({"a=0:1:12"});
  const auto of = [&](double base, double effect, double noise) {
    return table_of(
        ranges, {0.5}, design(DesignKind::kGrid, ranges, 0, 1), 6,
        [=](const std::vector<double>& point, const ResponseCase& on) {
          RandomStream random = rng(on.seed, fmt::format("{} {}", point[0], on.scenario));
          return base * std::exp((point[0] == 1.0 ? effect : 0.0) + noise * random.normal());
        });
  };
  const Effect single = effect_of(of(1.0, 0.5, 0.01), absolute());
  ASSERT_TRUE(single.is_resolved());
  EXPECT_TRUE(single.of_one_point);
  EXPECT_FALSE(single.tells_best()) << "the point is worse, and the others do not differ";
  EXPECT_TRUE(effect_of(of(1.0, -0.5, 0.01), absolute()).tells_best()) << "it is the best one";
  EXPECT_FALSE(single.small);
  EXPECT_NE(text_of(single).find("by a single point alone"), std::string::npos) << text_of(single);
  EXPECT_NE(text_of(single).find("permutation test on the variance over points of their sums over "
                                 "seeds, 199 draws"),
            std::string::npos);
  EXPECT_TRUE(effect_of(of(1.0, 0.004, 0.0), absolute()).small) << "0.4 %";
  EXPECT_TRUE(effect_of(of(0.01, 0.5, 0.0), absolute()).small) << "6 mm";
  EXPECT_NE(text_of(effect_of(of(1.0, 0.004, 0.0), absolute())).find("; small, as comparisons"),
            std::string::npos);
  EXPECT_NE(text_of(effect_of(of(1.0, 0.9, 0.0), absolute())).find("(146 % of the least)"),
            std::string::npos);
}

TEST(Effect, OfRunsThatAllDivergeHidesBehindThePenalty) {
  const auto ranges = ranges_of({"a=0:1:5"});
  auto table = table_of(
      ranges, {0.5}, design(DesignKind::kGrid, ranges, 0, 1), 3,
      [](const std::vector<double>& point, const ResponseCase&) { return 0.2 + point[0]; });
  for (auto& runs : table.runs) {
    for (RunScore& run : runs) run.diverged = true;
  }
  for (RunScore& run : table.default_runs) run.diverged = true;
  Objective objective = absolute();
  objective.divergence_penalty = 10.0;
  const Effect hidden = effect_of(table, objective);
  EXPECT_TRUE(hidden.is_none());
  EXPECT_EQ(hidden.saturated, hidden.cases);
  EXPECT_NE(text_of(hidden).find("the run diverged at every point and counts the penalty"),
            std::string::npos)
      << text_of(hidden);
  EXPECT_FALSE(best_point(table, objective));
  objective.divergence_penalty = 0.0;
  const Effect seen = effect_of(table, objective);
  EXPECT_EQ(seen.saturated, 0U);
  EXPECT_NEAR(seen.least, 0.2, 1e-12);
  EXPECT_NEAR(seen.most, 1.2, 1e-12);
  const auto best = best_point(table, objective);
  ASSERT_TRUE(best) << best.error().message;
  for (RunScore& run : table.runs[0]) run.value.reset();  // crashed: never the best for that
  EXPECT_EQ(effect_of(table, objective).most, 10.0);
}

TEST(Effect, ThatSoFewSeedsAndPointsCannotShowIsNotCalledScatter) {
  const auto ranges = ranges_of({"scale=1:1.4:5"});
  const auto of = [&](int seeds) {
    return effect_of(table_of(ranges, {1.2}, design(DesignKind::kGrid, ranges, 0, 1), seeds,
                              [](const std::vector<double>& point, const ResponseCase&) {
                                return std::abs(point[0] - 1.25) < 0.1 ? 1.0 : 20.0;
                              }),
                     absolute());
  };
  const Effect two = of(2);
  EXPECT_GT(two.p.value(), 0.05);
  EXPECT_FALSE(two.testable);
  EXPECT_NE(text_of(two).find("not resolved: too few seeds and points for the test below"),
            std::string::npos)
      << text_of(two);
  EXPECT_TRUE(of(4).testable);
  EXPECT_TRUE(of(4).is_resolved());
}

TEST(Effect, BelowTheScatterOfSeedsResolvesNoIndex) {
  const auto ranges = ranges_of({"a=0:1:4", "b=0:1:4"});
  const auto of = [&](double effect, double noise, int seeds) {
    return table_of(ranges, {0.5, 0.5}, design(DesignKind::kGrid, ranges, 0, 1), seeds,
                    [=](const std::vector<double>& point, const ResponseCase& on) {
                      RandomStream random =
                          rng(on.seed, fmt::format("{} {} {}", point[0], point[1], on.scenario));
                      return std::exp(effect * point[0] + noise * random.normal());
                    });
  };
  const auto noise = sensitivity_of(of(0.0, 0.01, 4), absolute());
  ASSERT_TRUE(noise);
  EXPECT_TRUE(noise->of_grid);
  EXPECT_GT(noise->effect.p.value(), 0.05);
  EXPECT_FALSE(noise->is_resolved());
  EXPECT_NE(response_markdown(of(0.0, 0.01, 4), absolute()).find("| not resolved | not resolved |"),
            std::string::npos);
  const auto small = sensitivity_of(of(0.03, 0.001, 4), absolute());
  ASSERT_TRUE(small);
  EXPECT_TRUE(small->is_resolved()) << "3 %, of which every seed is sure";
  EXPECT_LE(small->effect.p.value(), 0.05);
  EXPECT_FALSE(effect_of(of(0.03, 0.0, 1), absolute()).is_resolved()) << "one seed";
  EXPECT_TRUE(effect_of(of(0.3, 0.0, 1), absolute()).is_resolved());
  const Effect none = effect_of(of(0.0, 0.0, 2), absolute());
  EXPECT_TRUE(none.is_none());
  EXPECT_NE(text_of(none).find("no effect was measured"), std::string::npos);
}

TEST(Sensitivity, TellsWhichParameterDoesNotMatter) {
  const auto ranges = ranges_of({"a=0:6", "b=log(1,100)", "inert=0:1"});
  const auto table =
      table_of(ranges, {4.0, 30.0, 0.5}, design(DesignKind::kSobol, ranges, 96, 1), 3, bowl);
  const auto sensitivity = sensitivity_of(table, absolute());
  ASSERT_TRUE(sensitivity);
  EXPECT_TRUE(sensitivity->logarithmic);
  EXPECT_TRUE(sensitivity->is_resolved());
  EXPECT_FALSE(sensitivity->is_negligible(0));
  EXPECT_FALSE(sensitivity->is_negligible(1));
  EXPECT_TRUE(sensitivity->is_negligible(2));
}

TEST(Sensitivity, OfNoiseTrustsNothing) {
  const auto ranges = ranges_of({"a=0:6", "b=0:1"});
  RandomStream random = rng(1, "test.noise");
  const auto table = table_of(
      ranges, {3.0, 0.5}, design(DesignKind::kSobol, ranges, 64, 1), 2,
      [&](const std::vector<double>&, const ResponseCase&) { return std::exp(random.normal()); });
  const auto sensitivity = sensitivity_of(table, absolute());
  ASSERT_TRUE(sensitivity);
  EXPECT_FALSE(sensitivity->is_resolved());
  EXPECT_FALSE(sensitivity->is_negligible(0));
  EXPECT_TRUE(curve_of(table, absolute(), 0).is_empty());
}

TEST(Sensitivity, OfAPartOfAGridIsThatOfTheWhole) {
  // ln = 2 a + 3 b with a, b = -1, 0, 1 and c without effect: 4 and 9 parts of 13, on the nine
  // points of a Latin square.
  const auto ranges = ranges_of({"a=-1:1:3", "b=-1:1:3", "c=0:2:3"});
  std::vector<std::vector<double>> square;
  for (int a = 0; a < 3; ++a) {
    for (int b = 0; b < 3; ++b) square.push_back({a - 1.0, b - 1.0, (a + b) % 3 * 1.0});
  }
  const auto of = [&](double noise) {
    return sensitivity_of(
        table_of(ranges, {-1.0, 1.0, 0.0}, square, 2,
                 [&](const std::vector<double>& point, const ResponseCase& on) {
                   RandomStream random = rng(on.seed, fmt::format("{}", fmt::join(point, " ")));
                   return std::exp(2.0 * point[0] + 3.0 * point[1] + noise * random.normal());
                 }),
        absolute());
  };
  const auto sensitivity = of(0.0);
  ASSERT_TRUE(sensitivity) << sensitivity.error().message;
  ASSERT_TRUE(sensitivity->of_part.has_value());
  EXPECT_FALSE(sensitivity->of_grid);
  EXPECT_NEAR(sensitivity->of_part->explained, 1.0, 1e-9);
  EXPECT_NEAR(sensitivity->indices.first[0], 4.0 / 13.0, 1e-9);
  EXPECT_NEAR(sensitivity->indices.total[1], 9.0 / 13.0, 1e-9);
  EXPECT_NEAR(sensitivity->indices.total[2], 0.0, 1e-9);
  const auto noisy = of(20.0);
  EXPECT_FALSE(noisy && noisy->is_resolved()) << "cross-validation does not support it";
}

TEST(Sensitivity, OfAGridWithHolesSeesPairs) {
  // ln = 2 a + 3 b + 4 a b with -1, 0, 1, and c without effect; two of 27 points are missing.
  const auto ranges = ranges_of({"a=-1:1:3", "b=-1:1:3", "c=0:2:3"});
  auto points = design(DesignKind::kGrid, ranges, 0, 1);
  points.erase(points.begin() + 5);
  points.erase(points.begin() + 9);
  const auto sensitivity = sensitivity_of(
      table_of(ranges, {-1.0, 1.0, 0.0}, points, 1,
               [](const std::vector<double>& point, const ResponseCase&) {
                 return std::exp(2.0 * point[0] + 3.0 * point[1] + 4.0 * point[0] * point[1]);
               }),
      absolute());
  ASSERT_TRUE(sensitivity) << sensitivity.error().message;
  ASSERT_TRUE(sensitivity->of_part && sensitivity->of_part->with_pairs);
  // The mean square of -1, 0, 1 is 2/3.
  const double first = 4.0 * 2.0 / 3.0;
  const double second = 9.0 * 2.0 / 3.0;
  const double pair = 16.0 * 4.0 / 9.0;
  EXPECT_NEAR(sensitivity->indices.first[0], first / (first + second + pair), 1e-9);
  EXPECT_NEAR(sensitivity->indices.second(0, 1), pair / (first + second + pair), 1e-9);
  EXPECT_NEAR(sensitivity->indices.total[0], (first + pair) / (first + second + pair), 1e-9);
}

TEST(Sensitivity, OfAGridIsThatOfItsPointsHoweverFewTheyAre) {
  // ln = 2 a + 3 b + 4 a b with a, b = -1 or 1, c without effect: 4, 9 and 16 parts of 29.
  const auto ranges = ranges_of({"a=-1:1:2", "b=-1:1:2", "c=0:1:2"});
  const auto table = table_of(ranges, {-1.0, 1.0, 0.0}, design(DesignKind::kGrid, ranges, 0, 1), 2,
                              [](const std::vector<double>& point, const ResponseCase& on) {
                                const double exponent =
                                    2.0 * point[0] + 3.0 * point[1] + 4.0 * point[0] * point[1];
                                return static_cast<double>(on.seed) * std::exp(exponent);
                              });
  const auto sensitivity = sensitivity_of(table, absolute());
  ASSERT_TRUE(sensitivity) << sensitivity.error().message;
  EXPECT_TRUE(sensitivity->of_grid);
  EXPECT_TRUE(sensitivity->is_resolved());
  const SobolIndices& indices = sensitivity->indices;
  EXPECT_NEAR(indices.first[0], 4.0 / 29.0, 1e-9);
  EXPECT_NEAR(indices.first[1], 9.0 / 29.0, 1e-9);
  EXPECT_NEAR(indices.total[0], 20.0 / 29.0, 1e-9);
  EXPECT_NEAR(indices.total[1], 25.0 / 29.0, 1e-9);
  EXPECT_NEAR(indices.second(0, 1), 16.0 / 29.0, 1e-9);
  EXPECT_NEAR(indices.total[2], 0.0, 1e-9);
  EXPECT_TRUE(sensitivity->is_negligible(2));
}

TEST(Sensitivity, IsNotResolvedByAFitThatExplainsTwoThirds) {
  const auto ranges = ranges_of({"a=0:1", "b=0:1"});
  RandomStream random = rng(3, "test.noise");
  const auto table = table_of(ranges, {0.5, 0.5}, design(DesignKind::kSobol, ranges, 128, 1), 1,
                              [&](const std::vector<double>& point, const ResponseCase&) {
                                return std::exp(point[0] + 0.28 * random.normal());
                              });
  const auto sensitivity = sensitivity_of(table, absolute());
  ASSERT_TRUE(sensitivity);
  ASSERT_GT(sensitivity->surrogate->explained(), 0.5);
  ASSERT_LT(sensitivity->surrogate->explained(), 0.9);
  EXPECT_FALSE(sensitivity->is_resolved());
  EXPECT_TRUE(curve_of(table, absolute(), 0).fit.empty());
}

TEST(Slice, OfTwoValuesHasTwoPointsAndNoFit) {
  const auto ranges = ranges_of({"a=0:6:3", "b=log(1,100,3)", "alpha=0.5:0.95:2"});
  const auto table =
      table_of(ranges, {4.0, 12.6, 0.9}, design(DesignKind::kGrid, ranges, 0, 1), 3, bowl);
  const Slice curve = curve_of(table, absolute(), 2);
  ASSERT_EQ(curve.measured.size(), 2U);
  EXPECT_EQ(curve.measured[0].x, 0.5);
  EXPECT_EQ(curve.measured[1].x, 0.95);
  EXPECT_TRUE(curve.fit.empty());
  EXPECT_EQ(held_text(table, curve), "a = 3 (default 4), b = 10 (default 12.6)");
}

TEST(Slice, OfOneParameterHasTheDefaultsAmongItsPoints) {
  const auto ranges = ranges_of({"a=0:6:4"});
  const auto table = table_of(
      ranges, {4.1}, design(DesignKind::kGrid, ranges, 0, 1), 2,
      [](const std::vector<double>& point, const ResponseCase&) { return 1.0 + point[0]; });
  const Slice curve = curve_of(table, absolute(), 0);
  ASSERT_EQ(curve.measured.size(), 5U);
  EXPECT_EQ(curve.measured[3].x, 4.1);
  EXPECT_NEAR(*curve.measured[3].objective, 5.1, 1e-12);
  EXPECT_EQ(held_text(table, curve), "");
}

TEST(Slice, OfAGridIsMeasuredNextToTheDefaults) {
  const ResponseTable table = bowl_grid(4);
  const Slice curve = curve_of(table, absolute(), 0, "steep");
  ASSERT_EQ(curve.measured.size(), 13U);
  const auto cases = cases_of(table, "steep");
  for (const SlicePoint& point : curve.measured) {
    // 30 lies next to 31.6 of the grid's 1, 3.16, 10, 31.6, 100
    std::size_t row = 0;
    while (table.points[row][0] != point.x || std::abs(table.points[row][1] - 31.6) > 0.1) ++row;
    EXPECT_EQ(point.objective, objective_at(table, absolute(), row, cases));
    EXPECT_LE(*point.interval.low, *point.objective);
    EXPECT_GE(*point.interval.high, *point.objective);
  }
}

TEST(Slice, MapOfAGridHasEveryCell) {
  const Slice map = map_of(bowl_grid(2), absolute(), 0, 1);
  EXPECT_TRUE(map.fit.empty());
  ASSERT_EQ(map.measured.size(), 65U);
  EXPECT_EQ(map.measured[1].x, 0.5);
  EXPECT_EQ(map.measured[1].y, 1.0);
}

TEST(Slice, OfScatteredPointsFollowsTheSurrogate) {
  const auto ranges = ranges_of({"a=0:6", "b=log(1,100)"});
  const auto table =
      table_of(ranges, {2.0, 10.0}, design(DesignKind::kSobol, ranges, 96, 1), 4, bowl);
  const Slice curve = curve_of(table, absolute(), 0);
  ASSERT_EQ(curve.measured.size(), 1U) << "no point but the defaults lies on it";
  ASSERT_FALSE(curve.fit.empty());
  EXPECT_EQ(curve.fit.front().x, 0.0);
  EXPECT_EQ(curve.fit.back().x, 6.0);
  const double least = *curve.fit[8].objective;  // at a = 2
  EXPECT_GT(*curve.fit.front().objective, 1.3 * least);
  EXPECT_GT(*curve.fit.back().objective, 2.0 * least);
  EXPECT_EQ(map_of(table, absolute(), 0, 1).fit.size(), 24U * 24U);
}

TEST(Slice, OfACrowdEndsWhereNothingWasRun) {
  const auto ranges = ranges_of({"a=0:6", "b=log(1,100)"});
  auto points = design(DesignKind::kSobol, ranges, 96, 1);
  for (auto& point : points) point[0] *= 0.3;
  const auto table = table_of(ranges, {1.0, 10.0}, points, 4, bowl);
  const Slice curve = curve_of(table, absolute(), 0);
  ASSERT_FALSE(curve.fit.empty());
  EXPECT_TRUE(curve.fit.front().objective.has_value());
  EXPECT_EQ(curve.fit.back().x, 6.0);
  EXPECT_FALSE(curve.fit.back().objective.has_value());
}

}  // namespace
}  // namespace aims
