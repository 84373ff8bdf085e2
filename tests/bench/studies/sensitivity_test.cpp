// SPDX-License-Identifier: BSD-3-Clause
#include "bench/studies/sensitivity.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>

namespace aims {
namespace {

const SettingVariant* variant_of(const std::vector<SettingVariant>& variants,
                                 const std::string& key, double factor) {
  const auto at = std::ranges::find_if(variants, [&](const SettingVariant& each) {
    return each.key == key && each.factor == factor;
  });
  return at == variants.end() ? nullptr : &*at;
}

std::string value_of(const SettingVariant& variant) { return variant.spec->settings.back().second; }

TEST(SettingVariants, ScaleEachNumberThatHasAnEffect) {
  const auto variants = setting_variants("aims_d", {0.5, 2.0}, {});
  ASSERT_TRUE(variants) << variants.error().message;
  EXPECT_EQ(value_of(*variant_of(*variants, "map.voxel_size", 0.5)), "0.25");
  EXPECT_EQ(value_of(*variant_of(*variants, "lidar.max_points", 2.0)), "8000");
  EXPECT_EQ(value_of(*variant_of(*variants, "legs.velocity_sigma", 2.0)), "[0.06,0.06,0.06]");
  EXPECT_EQ(variant_of(*variants, "degeneracy.eta", 2.0), nullptr) << "has no effect";
  EXPECT_EQ(variant_of(*variants, "robust_kernel.enabled", 2.0), nullptr) << "is no number";
  std::vector<std::string> specs = {"aims_d"};
  for (const SettingVariant& each : *variants) {
    if (each.spec) specs.push_back(text_of(*each.spec));
  }
  EXPECT_TRUE(check_estimator_specs(specs)) << "one label each";
}

TEST(SettingVariants, AValueThatIsNotAllowedHasNoSpec) {
  const auto variants = setting_variants("aims", {0.001, 3.0}, {});
  ASSERT_TRUE(variants) << variants.error().message;
  EXPECT_FALSE(variant_of(*variants, "lidar.max_iterations", 0.001)->spec) << "at least 1";
  EXPECT_FALSE(variant_of(*variants, "degeneracy.w1", 3.0)->spec) << "at most 1";
  EXPECT_FALSE(setting_variants("amis", {2.0}, {}));
}

RunRecord record_of(std::uint64_t seed, const std::map<std::string, std::optional<double>>& ate) {
  RunRecord record{seed, {{"seed", seed}, {"robot", {{"fell", false}}}}};
  for (const auto& [label, value] : ate) {
    Json scores = {{"success", value.has_value()}};
    scores["ate_yaw_m"] = value.value_or(100.0);
    record.scores["estimators"][label] = std::move(scores);
  }
  return record;
}

TEST(Sensitivity, IsTheRatioOfMediansOverAllScenariosAndSortedByIt) {
  const auto all = setting_variants("aims_d", {0.5, 2.0}, {});
  ASSERT_TRUE(all);
  std::vector<SettingVariant> variants;
  for (const SettingVariant& each : *all) {
    if (each.key == "map.voxel_size" || each.key == "queue.lag") variants.push_back(each);
  }
  ASSERT_EQ(variants.size(), 4U);
  Suite suite;
  for (const double scale : {1.0, 10.0}) {
    SuiteCase each;
    each.scenario.name = scale > 1.0 ? "b" : "a";
    for (const std::uint64_t seed : {1, 2, 3}) {
      const double ate = 0.1 * scale * static_cast<double>(seed);
      const bool lost = scale > 1.0 && seed == 3;
      each.runs.push_back(record_of(
          seed, {{"aims_d", ate},
                 {"map_voxel_size_times_0_5", 1.2 * ate},
                 {"map_voxel_size_times_2", lost ? std::nullopt : std::optional(0.5 * ate)},
                 {"queue_lag_times_0_5", ate},
                 {"queue_lag_times_2", 1.1 * ate}}));
    }
    suite.cases.push_back(std::move(each));
  }
  const SettingSensitivity sensitivity = sensitivity_of(suite, "aims_d", variants);
  EXPECT_EQ(sensitivity.sequences, 6U);
  EXPECT_NEAR(*sensitivity.median_ate, 0.65, 1e-12);
  ASSERT_EQ(sensitivity.rows.size(), 2U);
  const SensitivityRow& voxel = sensitivity.rows.at(0);
  EXPECT_EQ(voxel.key, "map.voxel_size");
  EXPECT_NEAR(*voxel.cells.at(0).ratio, 1.2, 1e-12);
  EXPECT_NEAR(*voxel.cells.at(1).ratio, 0.5, 1e-12) << "the lost run keeps its ATE";
  EXPECT_EQ(voxel.cells.at(1).lost, 1);
  EXPECT_EQ(voxel.cells.at(1).won, 0);
  EXPECT_NEAR(*sensitivity.rows.at(1).largest_change(), 0.1, 1e-12);
  const TextTable table = sensitivity_table(sensitivity);
  EXPECT_EQ(table.rows.at(0).at(3), "0.500 (-1) p 1");
}

}  // namespace
}  // namespace aims
