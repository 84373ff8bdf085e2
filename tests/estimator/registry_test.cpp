// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/registry.hpp"

#include <gtest/gtest.h>

namespace aims {
namespace {

TEST(Registry, CreatesEveryListedEstimator) {
  for (const EstimatorEntry& entry : estimator_registry()) {
    const auto made = make_estimator(entry.name, EstimatorConfig{}, SensorRig{});
    ASSERT_TRUE(made.has_value()) << entry.name;
    EXPECT_TRUE((*made)->result().trajectory.empty());
    EXPECT_FALSE(entry.description.empty());
  }
}

TEST(Registry, UnknownNameGetsANearMatchAndTheList) {
  const auto made = make_estimator("amis", EstimatorConfig{}, SensorRig{});
  ASSERT_FALSE(made.has_value());
  EXPECT_NE(made.error().message.find("did you mean 'aims'"), std::string::npos);
  EXPECT_NE(made.error().message.find("tfs_clean"), std::string::npos);
}

TEST(EstimatorConfig, DefaultsLieInTheirRanges) {
  EstimatorConfig config;
  const Fields fields = fields_of(config);
  EXPECT_GT(fields.parameters().size(), 50U);
  for (const Parameter& parameter : fields.parameters()) {
    EXPECT_TRUE(parameter.assign(parameter.text())) << parameter.key << " = " << parameter.text();
    EXPECT_FALSE(parameter.spec.meaning.empty()) << parameter.key;
  }
}

}  // namespace
}  // namespace aims
