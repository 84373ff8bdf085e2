// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/registry.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "core/series_style.hpp"

namespace aims {
namespace {

TEST(Registry, CreatesEveryListedEstimator) {
  for (const EstimatorEntry& entry : estimator_registry()) {
    const auto made = make_estimator(entry.name, SensorRig{});
    ASSERT_TRUE(made.has_value()) << entry.name;
    EXPECT_TRUE((*made)->result().trajectory.empty());
    EXPECT_FALSE(entry.description.empty());
  }
}

TEST(Registry, EveryEstimatorHasAStyleOfItsOwnInPictures) {
  const std::vector<std::string> names = estimator_names();
  const auto together = series_styles(names);
  for (std::size_t i = 0; i < names.size(); ++i) {
    EXPECT_EQ(series_styles({&names[i], 1}).front(), together[i]) << names[i];
    EXPECT_EQ(std::ranges::count(together, together[i]), 1) << names[i];
  }
}

TEST(Registry, UnknownNameGetsANearMatchAndTheList) {
  const auto made = make_estimator("amis", SensorRig{});
  ASSERT_FALSE(made.has_value());
  EXPECT_NE(made.error().message.find("did you mean 'aims'"), std::string::npos);
  EXPECT_NE(made.error().message.find("tfs_clean"), std::string::npos);
}

TEST(EstimatorConfigs, DefaultsLieInTheirRanges) {
  EstimatorConfigs configs;
  const Fields fields = fields_of(configs);
  EXPECT_GT(fields.parameters().size(), 50U);
  for (const Parameter& parameter : fields.parameters()) {
    EXPECT_TRUE(parameter.assign(parameter.text())) << parameter.key << " = " << parameter.text();
    EXPECT_FALSE(parameter.spec.meaning.empty()) << parameter.key;
  }
}

std::string text_of(const EstimatorConfigs& configs, const char* key) {
  EstimatorConfigs copy = configs;
  return fields_of(copy).find(key)->text();
}

TEST(EstimatorConfigs, CopiesAreDeep) {
  EstimatorConfigs configs;
  const EstimatorConfigs before = configs;
  ASSERT_TRUE(assign(fields_of(configs), "aims.degeneracy.eta", "7"));
  EXPECT_EQ(text_of(configs, "aims.degeneracy.eta"), "7");
  EXPECT_EQ(text_of(before, "aims.degeneracy.eta"), "3");
  EXPECT_EQ(text_of(configs, "aims_d.degeneracy.eta"), "3");
}

TEST(EstimatorConfigs, LegsAreRequiredOnlyWhereTheyAreFused) {
  EstimatorConfigs configs;
  EXPECT_TRUE(configs.find("aims")->requirements().legs);
  EXPECT_FALSE(configs.find("lio")->requirements().legs);
  EXPECT_FALSE(configs.find("leg")->requirements().lidar);
  ASSERT_TRUE(assign(fields_of(configs), "aims.legs.enabled", "false"));
  EXPECT_FALSE(configs.find("aims")->requirements().legs);
}

TEST(EstimatorConfigs, ReasonsOfIdleSettingsNameTheSwitch) {
  EstimatorConfigs configs;
  const Fields fields = fields_of(configs);
  const auto idle = [&](const char* key) { return fields.find(key)->idle; };
  EXPECT_EQ(idle("aims.degeneracy.eta"), "");
  EXPECT_EQ(idle("tfs.degeneracy.eta"), "degeneracy.enabled is false");
  EXPECT_EQ(idle("tfs.degeneracy.enabled"), "");
  EXPECT_EQ(idle("lio.legs.repeat_lost"), "legs.enabled is false");
  EXPECT_EQ(idle("lio.leg_states.enabled"), "legs.enabled is false");
  EXPECT_EQ(idle("aims.leg_states.scale_sigma"), "leg_states.enabled is false");
  EXPECT_EQ(idle("aims.calibration.mount_sigma"), "");
}

TEST(EstimatorConfigs, AimsDHasFortySettingsWithAnEffect) {
  EstimatorConfigs configs;
  const Fields fields = fields_of(configs);
  const auto acts = [](const Parameter& parameter) {
    return parameter.key.starts_with("aims_d.") && parameter.idle.empty();
  };
  EXPECT_LE(std::ranges::count_if(fields.parameters(), acts), 40);
}

TEST(EstimatorConfigs, EveryNumberOfAimsDHasAUnitAndASource) {
  EstimatorConfigs configs;
  const Fields fields = fields_of(configs);
  for (const Parameter& parameter : fields.parameters()) {
    if (!parameter.key.starts_with("aims_d.") || !parameter.idle.empty()) continue;
    if (!is_number(parameter) && !is_sequence(parameter)) continue;
    EXPECT_NE(parameter.spec.unit, "") << parameter.key;
    EXPECT_NE(parameter.spec.source, "") << parameter.key;
  }
}

}  // namespace
}  // namespace aims
