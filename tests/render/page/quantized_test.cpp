// SPDX-License-Identifier: BSD-3-Clause
#include "render/page/page_data.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/random.hpp"
#include "tests/render/page/decoded_page.hpp"

namespace aims {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
constexpr std::uint64_t kSeed = 5;

/// The values after a page was written and read.
std::vector<float> round_trip(const std::vector<double>& values, std::size_t components = 1,
                              const Precision& precision = {}) {
  PageData page;
  page.json["values"] = page.q16(values, components, precision);
  const auto back = testing::decoded(payload_text(page));
  return back.f32(back.json["values"]);
}

TEST(Quantized, ValuesComeBackToHalfAStepOfTheirOwnColumn) {
  RandomStream stream(kSeed, "values");
  std::vector<double> values;
  for (int i = 0; i < 2000; ++i) {
    values.push_back(stream.uniform(-0.5, 0.5));
    values.push_back(stream.uniform(90.0, 100.0));
  }
  const auto back = round_trip(values, 2);
  ASSERT_EQ(back.size(), values.size());
  for (std::size_t i = 0; i < values.size(); i += 2) {
    EXPECT_NEAR(back[i], values[i], 0.5 / 65534 + 1e-7) << "seed " << kSeed;
    EXPECT_NEAR(back[i + 1], values[i + 1], 5.0 / 65534 + 1e-5) << "seed " << kSeed;
  }
}

TEST(Quantized, PositiveValuesOfManyDecadesKeepTheirFirstFourDigits) {
  std::vector<double> values;
  for (double value = 1e-4; value < 1e7; value *= 1.1) values.push_back(value);
  const auto column = quantized(values);
  ASSERT_TRUE(column);
  EXPECT_TRUE(column->logarithmic);
  const auto back = round_trip(values);
  for (std::size_t i = 0; i < values.size(); ++i) EXPECT_NEAR(back[i] / values[i], 1.0, 4e-4);
}

TEST(Quantized, NoValueStaysNoneAndOneValueIsExact) {
  const auto back = round_trip({kNone, 0.1, kNone, kNone, 0.1});
  EXPECT_TRUE(std::isnan(back[0]) && std::isnan(back[2]) && std::isnan(back[3]));
  EXPECT_FLOAT_EQ(back[1], 0.1F);
  EXPECT_FLOAT_EQ(back[4], 0.1F);
}

TEST(Quantized, AColumnThatSixteenBitsWouldMissStaysAsItIs) {
  // Millimetres for most of the time, then kilometres with either sign.
  std::vector<double> values;
  for (int i = 0; i < 100; ++i) values.push_back(1e-3 * i);
  values.insert(values.end(), {-4e3, 5e3});
  EXPECT_FALSE(quantized(values));
  const auto back = round_trip(values);
  for (std::size_t i = 0; i < values.size(); ++i) {
    EXPECT_EQ(back[i], static_cast<float>(values[i]));
  }
  EXPECT_FALSE(quantized(std::vector<double>{1.0, std::numeric_limits<double>::infinity()}));
}

TEST(Quantized, StepsAreNoFinerThanAsked) {
  const auto column = quantized(std::vector<double>{0.0, 0.004, 1.0}, {0.01, 0.0});
  ASSERT_TRUE(column);
  EXPECT_EQ(column->step, 0.01);
  EXPECT_EQ(column->codes, (std::vector<std::uint16_t>{0, 0, 100}));
}

TEST(Quantized, EqualArraysAreStoredOnce) {
  PageData page;
  const std::vector<float> t = {0.1F, 0.2F, 0.3F};
  const auto first = page.f32(t);
  const auto second = page.f32(t);
  EXPECT_EQ(first, second);
  EXPECT_EQ(page.block().size(), 12U);
}

}  // namespace
}  // namespace aims
