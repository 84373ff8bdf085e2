// SPDX-License-Identifier: BSD-3-Clause
#include "bench/studies/comparison.hpp"

#include <gtest/gtest.h>
#include <utility>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "core/random.hpp"
#include "tests/support/temporary_folder.hpp"

namespace aims {
namespace {

/// Runs of one scenario and estimator, seeds from 1, with these ATEs.
std::vector<RunRecord> runs(const std::vector<double>& ates) {
  std::vector<RunRecord> result;
  for (const double ate : ates) {
    RunRecord run;
    run.seed = result.size() + 1;
    run.scores["estimators"]["aims"] = {{"ate_m", ate}, {"success", ate < 5.0}};
    result.push_back(std::move(run));
  }
  return result;
}

StoredResults results(const std::vector<double>& ates) { return {{"walk", runs(ates)}}; }

const ScoreChange& ate_change(const Comparison& comparison) {
  for (const ScoreChange& change : comparison.changes) {
    if (change.score == "ate_m") return change;
  }
  throw std::runtime_error("no ATE was compared");
}

const std::vector<double> kBefore = {0.20, 0.35, 0.28, 0.22, 0.31, 0.40};

bool has(const std::string& text, const std::string& words) {
  return text.find(words) != std::string::npos;
}

std::vector<double> shifted(double by) {
  std::vector<double> after = kBefore;
  for (std::size_t i = 0; i < after.size(); ++i) {
    after[i] += by + 0.002 * static_cast<double>(i % 3);
  }
  return after;
}

TEST(Compare, SaysWhatIsWorseOrBetterBeyondNoise) {
  const auto worse = compare(results(kBefore), results(shifted(0.1)));
  EXPECT_EQ(ate_change(worse).verdict, ChangeVerdict::kWorse);
  EXPECT_NEAR(ate_change(worse).test.change, 0.102, 1e-9);
  EXPECT_EQ(ate_change(worse).pairs, 6U);
  const auto better = compare(results(shifted(0.1)), results(kBefore));
  EXPECT_EQ(ate_change(better).verdict, ChangeVerdict::kBetter);
}

TEST(Compare, PairsSeedsSoThatTheirSpreadDoesNotHideAChange) {
  // The change is a fifth of the spread over seeds.
  EXPECT_EQ(ate_change(compare(results(kBefore), results(shifted(0.015)))).verdict,
            ChangeVerdict::kWorse);
}

TEST(Compare, PassesOverSmallChangesAndNoise) {
  EXPECT_EQ(ate_change(compare(results(kBefore), results(shifted(0.004)))).verdict,
            ChangeVerdict::kSmall)
      << "below the floor of 1 cm, though in every pair";
  std::vector<double> noisy = kBefore;
  noisy[0] += 0.5;
  noisy[1] -= 0.2;
  noisy[2] -= 0.1;
  EXPECT_EQ(ate_change(compare(results(kBefore), results(noisy))).verdict, ChangeVerdict::kNone);
}

TEST(Compare, NamesWhatHasNoValidRunOnTheOtherSide) {
  const std::vector<std::string> walk = {"walk, aims"};
  EXPECT_TRUE(compare(results(kBefore), results({0.2})).not_compared.empty()) << "one pair";
  EXPECT_EQ(compare(results(kBefore), {{"other", runs({0.2})}}).not_compared, walk);
  StoredResults invalid = results(kBefore);
  for (RunRecord& run : invalid.at("walk")) {
    run.scores["robot"] = {{"end", "fell"}, {"valid", false}, {"invalid_reason", "the robot fell"}};
  }
  EXPECT_EQ(compare(results(kBefore), invalid).not_compared, walk);
  EXPECT_TRUE(compare(invalid, results(kBefore)).not_compared.empty()) << "nothing was lost";
}

TEST(Compare, CallsRoundingTheSame) {
  std::vector<double> rounded = kBefore;
  for (double& each : rounded) each += 1e-9;
  EXPECT_EQ(ate_change(compare(results(kBefore), results(rounded))).verdict, ChangeVerdict::kSame);
  EXPECT_EQ(ate_change(compare(results({0.2}), results({0.2 + 1e-9}))).verdict,
            ChangeVerdict::kSame);
  rounded[2] += 1e-5;
  EXPECT_NE(ate_change(compare(results(kBefore), results(rounded))).verdict, ChangeVerdict::kSame);
}

TEST(Compare, NamesADetectableChangeWhereNothingWasDetectedAlone) {
  const auto detectable = [](const std::vector<double>& after) {
    const TextTable table = change_table(compare(results(kBefore), results(after)));
    const auto column = std::ranges::find(table.header, "detectable") - table.header.begin();
    for (const auto& row : table.rows) {
      if (row[2] == "ate_m") return row[static_cast<std::size_t>(column)];
    }
    return std::string("no row");
  };
  std::vector<double> noisy = kBefore;
  noisy[0] += 0.5;
  noisy[1] -= 0.2;
  noisy[2] -= 0.1;
  EXPECT_NE(detectable(noisy), "-");
  EXPECT_EQ(detectable(kBefore), "-") << "same";
  EXPECT_EQ(detectable(shifted(0.004)), "-") << "small";
  EXPECT_EQ(detectable(shifted(0.1)), "-") << "worse";
}

TEST(Compare, OfTheSameResultsFindsNothingAndExpectsNothing) {
  const Comparison same = compare(results(kBefore), results(kBefore));
  EXPECT_EQ(count(same, ChangeVerdict::kSame), same.changes.size());
  EXPECT_EQ(change_table(same).rows.size(), same.changes.size());
  EXPECT_EQ(same.expected_false_alarms, 0.0);
  EXPECT_TRUE(same.only_before.empty());
}

TEST(Compare, ExpectsAsManyFalseAlarmsAsThereAre) {
  // Where nothing changed but by chance, the verdicts must be as many as were announced.
  RandomStream random = rng(7, "test.compare");
  double expected = 0.0;
  std::size_t found = 0;
  for (int trial = 0; trial < 300; ++trial) {
    std::vector<double> before(8);
    std::vector<double> after(8);
    for (std::size_t i = 0; i < before.size(); ++i) {
      before[i] = 1.0 + 0.1 * random.normal();
      after[i] = before[i] + 0.2 * random.normal();
    }
    const Comparison comparison = compare(results(before), results(after));
    expected += ate_change(comparison).false_alarm;
    const ChangeVerdict verdict = ate_change(comparison).verdict;
    found += verdict == ChangeVerdict::kBetter || verdict == ChangeVerdict::kWorse;
  }
  EXPECT_GT(expected, 10.0);
  EXPECT_LE(expected, 0.05 * 300) << "one in twenty at most";
  EXPECT_NEAR(static_cast<double>(found), expected, 4.0 * std::sqrt(expected));
}

TEST(Compare, OfTooFewSeedsHasATableThatSaysWhatTheTestCanReach) {
  const Comparison three =
      compare(results({0.0077, 0.0070, 0.0080}), results({0.0201, 0.02, 0.03}));
  const ScoreChange& change = ate_change(three);
  EXPECT_EQ(change.verdict, ChangeVerdict::kTooFew);
  EXPECT_EQ(change.test.interval, Interval{}) << "an interval would claim what the test cannot";
  EXPECT_NEAR(change.after - change.before, change.test.change, 1e-12);
  const TextTable table = change_table(three);
  ASSERT_EQ(table.rows.size(), three.changes.size());
  EXPECT_EQ(table.rows[0][7], "0.250");
  EXPECT_EQ(table.rows[0].back(), "too few");
  EXPECT_TRUE(has(rule_text(three), "3 pairs: the smallest p that this test can reach is 0.25"));
  EXPECT_TRUE(has(summary_text(three), "1 differ on too few common seeds to tell: run 6 or more"));
}

TEST(Compare, WithOneCommonSeedKnowsNothingOfNoise) {
  const Comparison one = compare(results({0.2}), results({0.4, 0.1}));
  EXPECT_EQ(ate_change(one).verdict, ChangeVerdict::kTooFew);
  EXPECT_EQ(ate_change(one).test.interval, Interval{});
  EXPECT_EQ(one.only_after, std::vector<std::string>({"walk, aims, seed 2"}));
}

TEST(Compare, VerdictIntervalAndTableAgreeInEveryRow) {
  RandomStream random = rng(8, "test.compare");
  for (int trial = 0; trial < 200; ++trial) {
    std::vector<double> before(7);
    std::vector<double> after(7);
    for (std::size_t i = 0; i < before.size(); ++i) {
      before[i] = 0.3 + 0.02 * random.normal();
      after[i] = before[i] + 0.015 + 0.015 * random.normal();
    }
    const ScoreChange change = ate_change(compare(results(before), results(after)));
    const Interval& interval = change.test.interval;
    const bool excludes_zero = *interval.low > 0.0 || *interval.high < 0.0;
    EXPECT_EQ(change.verdict == ChangeVerdict::kNone, !excludes_zero);
    EXPECT_EQ(change.verdict == ChangeVerdict::kSmall,
              excludes_zero && std::abs(change.test.change) <= change.floor);
    EXPECT_NEAR(change.after - change.before, change.test.change, 1e-12);
  }
}

TEST(Compare, TheTableHasEveryScoreTheWorseOnesFirst) {
  StoredResults before = results(kBefore);
  StoredResults after = results(kBefore);
  before["other"] = runs(kBefore);
  after["other"] = runs(shifted(0.1));
  const TextTable table = change_table(compare(before, after));
  EXPECT_EQ(table.rows.size(), 4U);
  EXPECT_EQ(table.rows[0][0], "other");
  EXPECT_EQ(table.rows[0].back(), "worse");
  EXPECT_EQ(table.rows[1].back(), "same");
}

TEST(Compare, MoreSuccessIsBetter) {
  const auto lost = results(std::vector<double>(6, 9.0));
  const auto found = results(std::vector<double>(6, 0.1));
  const auto changes = compare(lost, found).changes;
  ASSERT_FALSE(changes.empty());
  for (const ScoreChange& change : changes) {
    EXPECT_EQ(change.verdict, ChangeVerdict::kBetter) << change.score;
  }
}

TEST(Compare, SuccessesAreComparedByMcNemarsTest) {
  // Fagerland, Lydersen and Laake 2013: 7 against 1 discordant pairs have p 0.0703.
  std::vector<double> before(9, 0.1);
  std::vector<double> after(9, 9.0);
  before[0] = 9.0;
  after[0] = 0.1;
  after[8] = 0.1;
  const auto change_in = [](const Comparison& comparison) {
    for (const ScoreChange& each : comparison.changes) {
      if (each.score == "success") return each;
    }
    throw std::runtime_error("no success was compared");
  };
  const ScoreChange change = change_in(compare(results(before), results(after)));
  EXPECT_EQ(change.success->only_first, 7U);
  EXPECT_EQ(change.success->only_second, 1U);
  EXPECT_NEAR(change.test.p, 0.0703, 5e-5);
  EXPECT_EQ(change.verdict, ChangeVerdict::kNone);
  EXPECT_EQ(change.test.interval, Interval{}) << "the sign-flip interval is of continuous scores";
  before[0] = 0.1;
  after[0] = 9.0;
  const ScoreChange lost = change_in(compare(results(before), results(after)));
  EXPECT_NEAR(lost.test.p, 2.0 / 256.0, 1e-12);
  EXPECT_EQ(lost.verdict, ChangeVerdict::kWorse);
  EXPECT_NEAR(lost.test.change, -8.0 / 9.0, 1e-12);
}

TEST(Compare, AnEstimatorThatFailsHasLostItsSuccess) {
  const StoredResults before = results(kBefore);
  StoredResults after = before;
  for (const std::size_t i : {0, 1, 2, 3, 4, 5}) {
    Json& scores = after["walk"][i].scores;
    scores["estimators"].erase("aims");
    scores["failures"] = {{{"estimator", "aims"}, {"message", "killed"}}};
  }
  const Comparison comparison = compare(before, after);
  EXPECT_EQ(comparison.fails_now, std::vector<std::string>{"walk, aims, seed 1,2,3,4,5,6"});
  EXPECT_TRUE(comparison.only_before.empty());
  EXPECT_EQ(count(comparison, ChangeVerdict::kWorse), 1U);
  const auto success = std::ranges::find(comparison.changes, kSuccessKey, &ScoreChange::score);
  ASSERT_NE(success, comparison.changes.end());
  EXPECT_EQ(success->pairs, 6U);
  EXPECT_EQ(success->after, 0.0);
  EXPECT_EQ(success->verdict, ChangeVerdict::kWorse);
  EXPECT_EQ(compare(after, before).fails_no_more.size(), 1U);
  EXPECT_TRUE(compare(after, after).fails_now.empty());
}

// The error of the first 3 s says nothing about a walk of 30 s.
TEST(Compare, AnEstimateThatEndsEarlyIsComparedByItsSuccessAlone) {
  const StoredResults before = results(kBefore);
  StoredResults after = before;
  for (RunRecord& run : after["walk"]) {
    run.scores["estimators"]["aims"] = {
        {"ate_m", 1e-5}, {"success", false}, {"diverged_reason", "ends_early"}};
  }
  const Comparison comparison = compare(before, after);
  EXPECT_EQ(count(comparison, ChangeVerdict::kBetter), 0U);
  EXPECT_EQ(count(comparison, ChangeVerdict::kWorse), 1U);
  EXPECT_EQ(comparison.partial, std::vector<std::string>{"after: walk, aims, seed 1,2,3,4,5,6"});
}

// Of one name, but of another task or another estimator.
TEST(Compare, NamesSequencesAndLabelsThatAreOtherOnes) {
  StoredResults before = results(kBefore);
  for (RunRecord& run : before["walk"]) {
    run.scores["simulated_s"] = 33.0;
    run.specs = {{"aims", "aims_d"}};
  }
  StoredResults after = before;
  EXPECT_EQ(settings_text(compare(before, after)), "");
  after["walk"][1].scores["simulated_s"] = 45.0;
  after["walk"][2].specs["aims"] = "aims_d+legs.enabled=false";
  const Comparison comparison = compare(before, after);
  EXPECT_EQ(comparison.other_sequences, std::vector<std::string>{"walk, seed 2"});
  EXPECT_EQ(comparison.other_specs,
            std::vector<std::string>{"aims: aims_d before, aims_d+legs.enabled=false after"});
  const std::string text = settings_text(comparison);
  EXPECT_NE(text.find("The sequences differ: walk, seed 2"), std::string::npos) << text;
  EXPECT_NE(text.find("One label, two estimators: aims"), std::string::npos) << text;
}

TEST(Compare, OfAnEstimatorThatFailedOnAllRunsIsTheSameBothWays) {
  const StoredResults whole = results(kBefore);
  StoredResults failed = whole;
  for (RunRecord& run : failed["walk"]) {
    run.scores["estimators"].clear();
    run.scores["failures"] = {{{"estimator", "aims"}, {"message", "killed"}}};
  }
  EXPECT_EQ(count(compare(whole, failed), ChangeVerdict::kWorse), 1U);
  EXPECT_EQ(count(compare(failed, whole), ChangeVerdict::kBetter), 1U);
}

TEST(Compare, NamesSettingsOfOneSideAndWhetherTheyAreOfTheTask) {
  const auto text = [](std::vector<std::string> before, std::vector<std::string> after) {
    return settings_text(with_settings({}, std::move(before), std::move(after)));
  };
  EXPECT_EQ(text({"scene.corridor.length=10"}, {"scene.corridor.length=10"}), "");
  const std::string task = text({"lidar.columns=300", "scene.corridor.length=10"},
                                {"scene.corridor.length=14", "lidar.columns=300"});
  EXPECT_NE(task.find("before: scene.corridor.length=10; after: scene.corridor.length=14.\n"
                      "The sequences differ"),
            std::string::npos)
      << task;
  const std::string own = text({}, {"estimators.aims.degeneracy.eta=0"});
  EXPECT_NE(own.find("before: nothing; after: estimators.aims"), std::string::npos) << own;
  EXPECT_EQ(own.find("sequences differ"), std::string::npos) << own;
}

TEST(StoredResults, OfAnEmptyFolderAreAnError) {
  const TemporaryFolder folder;
  const auto none = read_results(folder.path());
  ASSERT_FALSE(none);
  EXPECT_NE(none.error().message.find("holds no finished results"), std::string::npos);
}

}  // namespace
}  // namespace aims
