// SPDX-License-Identifier: BSD-3-Clause
#include "bench/metrics/detector.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "core/random.hpp"

namespace aims {
namespace {

/// Scans 0.1 s apart; a letter per scan: D = degenerate.
LabelledRun run_of(const std::string& truth, const std::vector<double>& scores) {
  LabelledRun run;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    run.push_back({static_cast<Time>(i) * 100 * kMillisecond, scores[i], truth[i] == 'D'});
  }
  return run;
}

/// Scores on a coarse grid, so that ties are common.
LabelledRun random_run(RandomStream& random, std::size_t scans, double share) {
  LabelledRun run;
  for (std::size_t i = 0; i < scans; ++i) {
    const bool degenerate = random.chance(share);
    const double score = std::floor(4.0 * random.normal() + (degenerate ? 2.0 : 0.0));
    run.push_back({static_cast<Time>(i), score, degenerate});
  }
  return run;
}

/// Every pair of a degenerate and another scan, counted one by one.
double auc_by_pairs(const std::vector<LabelledRun>& runs) {
  LabelledRun all;
  for (const LabelledRun& run : runs) all.insert(all.end(), run.begin(), run.end());
  double wins = 0.0;
  double pairs = 0.0;
  for (const LabelledScan& a : all) {
    for (const LabelledScan& b : all) {
      if (!a.degenerate || b.degenerate) continue;
      pairs += 1.0;
      wins += a.score > b.score ? 1.0 : (a.score == b.score ? 0.5 : 0.0);
    }
  }
  return wins / pairs;
}

double area_under(const std::vector<RocPoint>& curve) {
  double area = 0.0;
  for (std::size_t i = 1; i < curve.size(); ++i) {
    area += 0.5 * (curve[i].true_positive_rate + curve[i - 1].true_positive_rate) *
            (curve[i].false_positive_rate - curve[i - 1].false_positive_rate);
  }
  return area;
}

TEST(Auc, IsTheFractionOfOrderedPairsWithTiesCountingHalf) {
  RandomStream random(1, "test.detector");
  for (int round = 0; round < 20; ++round) {
    std::vector<LabelledRun> runs;
    for (int i = 0; i < 4; ++i) runs.push_back(random_run(random, 30, 0.1 + 0.2 * i));
    const double expected = auc_by_pairs(runs);
    EXPECT_NEAR(*AucTable(runs).auc(), expected, 1e-12) << "round " << round;
    EXPECT_NEAR(area_under(roc_curve(runs)), expected, 1e-12) << "round " << round;
  }
}

TEST(Auc, OfResampledRunsIsThatOfTheRunsRepeated) {
  RandomStream random(2, "test.detector");
  std::vector<LabelledRun> runs;
  for (int i = 0; i < 3; ++i) runs.push_back(random_run(random, 25, 0.4));
  const std::vector<std::size_t> picked = {2, 0, 2};
  EXPECT_NEAR(*AucTable(runs).auc(picked), auc_by_pairs({runs[2], runs[0], runs[2]}), 1e-12);
}

TEST(Auc, OfAPerfectScoreIsOneOfAReversedZeroOfAConstantHalf) {
  const std::string truth = "..DD.D";
  EXPECT_EQ(AucTable(std::vector<LabelledRun>{run_of(truth, {0, 0, 1, 1, 0, 1})}).auc(), 1.0);
  EXPECT_EQ(AucTable(std::vector<LabelledRun>{run_of(truth, {1, 1, 0, 0, 1, 0})}).auc(), 0.0);
  EXPECT_EQ(AucTable(std::vector<LabelledRun>{run_of(truth, {3, 3, 3, 3, 3, 3})}).auc(), 0.5);
}

TEST(Auc, HasNoValueUnlessBothClassesOccur) {
  for (const char* truth : {"...", "DDD", ""}) {
    const std::vector<LabelledRun> runs = {run_of(truth, {1, 2, 3})};
    EXPECT_FALSE(AucTable(runs).auc()) << truth;
    EXPECT_TRUE(roc_curve(runs).empty()) << truth;
  }
  EXPECT_FALSE(AucTable({}).auc());
  const std::vector<LabelledRun> mixed = {run_of("..", {1, 2}), run_of("DD", {3, 4})};
  EXPECT_EQ(AucTable(mixed).auc(), 1.0) << "pairs are formed across runs";
  EXPECT_FALSE(AucTable(mixed).auc(std::vector<std::size_t>{0, 0}));
}

TEST(Roc, RunsFromTheFirstCornerToTheLast) {
  const auto curve = roc_curve(std::vector<LabelledRun>{run_of("D.D.", {4, 3, 2, 1})});
  ASSERT_EQ(curve.size(), 5U);
  EXPECT_EQ(curve.front().true_positive_rate, 0.0);
  EXPECT_EQ(curve[1].true_positive_rate, 0.5);
  EXPECT_EQ(curve[1].false_positive_rate, 0.0);
  EXPECT_EQ(curve[2].false_positive_rate, 0.5);
  EXPECT_EQ(curve.back().true_positive_rate, 1.0);
  EXPECT_EQ(curve.back().false_positive_rate, 1.0);
}

TEST(Roc, TheOperatingPointKeepsTheFalsePositiveRate) {
  std::vector<double> scores;
  std::string truth;
  for (int i = 0; i < 100; ++i) {
    truth += '.';
    scores.push_back(i);
  }
  truth += "DD";
  scores.insert(scores.end(), {96.5, 50.0});
  const auto curve = roc_curve(std::vector<LabelledRun>{run_of(truth, scores)});
  const RocPoint point = operating_point(curve, 0.05);
  EXPECT_EQ(point.threshold, 95.0);
  EXPECT_EQ(point.false_positive_rate, 0.05);
  EXPECT_EQ(point.true_positive_rate, 0.5);
  EXPECT_EQ(operating_point(curve, 0.0).true_positive_rate, 0.0);
}

TEST(DetectionDelay, CountsFromTheOnsetToTheFirstAlarmInTheSameInterval) {
  //                               0123456789
  const LabelledRun run = run_of("..DDDD..DDD.", {0, 9, 0, 0, 9, 9, 0, 0, 0, 0, 0, 9});
  const DetectionDelays delays = detection_delays(run, 5.0, 0);
  EXPECT_EQ(delays.onsets, 2);
  ASSERT_EQ(delays.delays_s.size(), 1U);
  EXPECT_NEAR(delays.delays_s[0], 0.2, 1e-9);
  EXPECT_EQ(delays.missed(), 1);
}

TEST(DetectionDelay, OfAnAlarmThatIsAlreadyActiveIsZero) {
  const DetectionDelays delays = detection_delays(run_of(".DD", {9, 9, 0}), 5.0, 0);
  ASSERT_EQ(delays.delays_s.size(), 1U);
  EXPECT_EQ(delays.delays_s[0], 0.0);
}

TEST(DetectionDelay, AnIntervalAtTheStartHasNoOnset) {
  EXPECT_EQ(detection_delays(run_of("DDD..", {0, 0, 9, 0, 0}), 5.0, 0).onsets, 0);
  EXPECT_EQ(detection_delays(run_of("DDDDD", {0, 0, 9, 0, 0}), 5.0, 0).onsets, 0);
  EXPECT_EQ(detection_delays({}, 5.0, 0).onsets, 0);
}

TEST(DetectionDelay, FlickeringTruthIsOneIntervalAndAShortOneIsNone) {
  const Duration shortest = 300 * kMillisecond;
  const LabelledRun flicker =
      run_of("....D.DD.DDD....", {0, 0, 0, 0, 0, 0, 0, 9, 0, 0, 0, 0, 0, 0, 0, 0});
  const DetectionDelays once = detection_delays(flicker, 5.0, shortest);
  EXPECT_EQ(once.onsets, 1);
  ASSERT_EQ(once.delays_s.size(), 1U);
  EXPECT_NEAR(once.delays_s[0], 0.3, 1e-9);
  const LabelledRun blink = run_of("....D......", std::vector<double>(11, 0.0));
  EXPECT_EQ(detection_delays(blink, 5.0, shortest).onsets, 0);
  EXPECT_EQ(detection_delays(blink, 5.0, 0).onsets, 1);
}

}  // namespace
}  // namespace aims
