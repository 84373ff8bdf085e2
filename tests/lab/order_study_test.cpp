// SPDX-License-Identifier: BSD-3-Clause
#include "lab/order/order_study.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "core/files/atomic_file.hpp"
#include "tests/support/temporary_folder.hpp"

namespace aims {
namespace {

RunRecord run_of(std::uint64_t seed, const Json& drawn, double adaptive, double fixed) {
  RunRecord run;
  run.seed = seed;
  run.scores["drawn"] = drawn;
  run.scores["robot"] = {{"end", "route_done"}, {"valid", true}};
  run.scores["estimators"]["aims"] = {{"ate_m", adaptive}, {"m_end_m", adaptive}};
  run.scores["estimators"]["tfs"] = {{"ate_m", fixed}, {"m_end_m", fixed}};
  return run;
}

/// Forty units: the adaptive one gains 1 m per unit of loss, and 0.1 m per unit of range; `noise`
/// is unrelated. Below a loss of 0.5 it is worse.
StoredResults made_up() {
  std::vector<RunRecord> runs;
  for (int i = 0; i < 40; ++i) {
    const double loss = (i % 8) / 7.0;
    const double range = (i / 8) / 4.0;
    const double noise = ((i * 17) % 40) / 39.0;
    runs.push_back(run_of(static_cast<std::uint64_t>(i + 1),
                          {{"loss", loss}, {"range", range}, {"noise", noise}, {"side", "left"}},
                          1.0, 0.4 + loss + 0.4 * range));
  }
  return {{"conditions", runs}};
}

TEST(OrderStudy, TheConditionThatDecidesComesFirst) {
  const auto study = order_study(made_up(), {});
  ASSERT_TRUE(study) << study.error().message;
  ASSERT_EQ(study->conditions.size(), 3U) << "texts are no conditions";
  EXPECT_EQ(study->conditions[0].key, "loss");
  EXPECT_GT(study->conditions[0].association, 0.6);
  EXPECT_GT(study->conditions[0].interval.low.value(), 0.4);
  const auto& noise = *std::ranges::find(study->conditions, "noise", &OrderCondition::key);
  EXPECT_LT(noise.interval.low.value(), 0.0);
  EXPECT_GT(noise.interval.high.value(), 0.0);
}

TEST(OrderStudy, BinsHaveTheirMediansAndCounts) {
  const auto study = order_study(made_up(), {.bins = 4});
  ASSERT_TRUE(study);
  const std::vector<OrderBin>& bins = study->conditions[0].bins;
  ASSERT_EQ(bins.size(), 4U);
  EXPECT_EQ(bins[0].units, 10U);
  EXPECT_DOUBLE_EQ(bins[0].low, 0.0);
  EXPECT_DOUBLE_EQ(bins[0].high, 1.0 / 7.0);
  EXPECT_EQ(bins[0].better, 0U);
  EXPECT_EQ(bins[3].better, 10U);
  EXPECT_NEAR(bins[3].advantage, -0.6 + 6.5 / 7.0 + 0.2, 0.08);
}

TEST(OrderStudy, TheMapSpansTheTwoStrongestConditions) {
  const auto study = order_study(made_up(), {.bins = 2});
  ASSERT_TRUE(study);
  ASSERT_TRUE(study->map);
  EXPECT_EQ(study->map->x, "loss");
  EXPECT_EQ(study->map->y, "range");
  ASSERT_EQ(study->map->cells.size(), 4U);
  std::size_t units = 0;
  for (const OrderMap::Cell& cell : study->map->cells) units += cell.bin ? cell.bin->units : 0;
  EXPECT_EQ(units, 40U);
  EXPECT_EQ(map_table(*study->map).rows.size(), 2U);
}

TEST(OrderStudy, AgreementIsWithThePapersTable) {
  // TFS has 3.44 m and AIMS 0.16 m in the paper: the order holds where the adaptive one is better.
  const auto study = order_study(made_up(), {});
  ASSERT_TRUE(study);
  for (const OrderUnit& unit : study->units) {
    ASSERT_TRUE(unit.tau);
    EXPECT_EQ(*unit.tau > 0.0, unit.advantage > 0.0) << "seed " << unit.seed;
  }
}

TEST(OrderStudy, RunsWithoutBothScoresAreCountedAndLeftOut) {
  StoredResults results = made_up();
  results["conditions"][3].scores["estimators"].erase("tfs");
  results["conditions"][4].scores["robot"] = {
      {"end", "fell"}, {"valid", false}, {"invalid_reason", "the robot fell"}};
  const auto study = order_study(results, {});
  ASSERT_TRUE(study);
  EXPECT_EQ(study->units.size(), 38U);
  EXPECT_EQ(study->left_out, 2U);
}

TEST(OrderStudy, ResultsWithoutDrawsAreAnError) {
  StoredResults results = made_up();
  for (RunRecord& run : results["conditions"]) run.scores.erase("drawn");
  const auto study = order_study(results, {});
  ASSERT_FALSE(study);
  EXPECT_NE(study.error().message.find("aims"), std::string::npos);
}

TEST(OrderStudy, WritesItsFiles) {
  const TemporaryFolder folder;
  const auto study = order_study(made_up(), {});
  ASSERT_TRUE(study);
  ASSERT_TRUE(write_order(*study, "out/conditions", folder.path() / "order"));
  const auto csv = read_file(folder.path() / "order" / "order.csv");
  ASSERT_TRUE(csv);
  EXPECT_EQ(std::ranges::count(*csv, '\n'), 41);
  const auto json = read_file(folder.path() / "order" / "order.json");
  ASSERT_TRUE(json);
  EXPECT_EQ(Json::parse(*json)["conditions"].size(), 3U);
}

}  // namespace
}  // namespace aims
