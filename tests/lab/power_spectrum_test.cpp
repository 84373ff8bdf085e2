// SPDX-License-Identifier: BSD-3-Clause
#include "lab/fidelity/power_spectrum.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/random.hpp"

namespace aims {
namespace {

constexpr double kRate = 400.0;  ///< [Hz]
const std::vector<FrequencyBand> kBands = {{0.0, 0.5},   {0.5, 5.0},    {5.0, 12.5},   {12.5, 25.0},
                                           {25.0, 50.0}, {50.0, 100.0}, {100.0, 200.0}};

/// `seconds` of a sinusoid on an offset.
std::vector<double> sinusoid(double amplitude, double frequency, double offset, double seconds) {
  std::vector<double> series;
  for (int i = 0; i < static_cast<int>(seconds * kRate); ++i) {
    series.push_back(offset +
                     amplitude * std::sin(2.0 * std::numbers::pi * frequency * i / kRate + 0.3));
  }
  return series;
}

std::vector<double> white_noise(double density, int count, std::uint64_t seed) {
  ::testing::Test::RecordProperty("seed", static_cast<int>(seed));
  RandomStream random(seed, "test.noise");
  std::vector<double> series;
  for (int i = 0; i < count; ++i) {
    series.push_back(density * std::sqrt(kRate / 2.0) * random.normal());
  }
  return series;
}

TEST(PowerSpectrum, ASinusoidIsInItsBandWithItsRmsAndNowhereElse) {
  for (const double frequency : {4.4, 8.13, 30.0, 160.0}) {
    const auto rms = *band_rms(sinusoid(3.0, frequency, 9.81, 15.3), kRate, kBands);
    const double expected = 3.0 / std::numbers::sqrt2;
    for (std::size_t i = 0; i < kBands.size(); ++i) {
      const double away =
          std::max(kBands[i].from - frequency, frequency - kBands[i].to);  // to the near edge [Hz]
      if (away < 0.0) {
        EXPECT_NEAR(rms[i], expected, 0.01 * expected) << frequency;
      } else {
        // Beyond its main lobe of 0.5 Hz the window has side lobes of at most 3 %.
        EXPECT_LT(rms[i], (away < 2.0 ? 0.03 : 0.006) * expected) << frequency << " in band " << i;
      }
    }
  }
}

TEST(PowerSpectrum, OfTwoSinusoidsEachHasItsRms) {
  std::vector<double> series = sinusoid(3.0, 4.4, 0.0, 16.0);
  const std::vector<double> other = sinusoid(0.02, 70.0, 0.0, 16.0);
  for (std::size_t i = 0; i < series.size(); ++i) series[i] += other[i];
  const auto rms = *band_rms(series, kRate, kBands);
  EXPECT_NEAR(rms[1], 3.0 / std::numbers::sqrt2, 0.02);
  EXPECT_NEAR(rms[5], 0.02 / std::numbers::sqrt2, 0.0003);
}

TEST(PowerSpectrum, WhiteNoiseFillsEachBandByTheRootOfItsWidth) {
  // The one-sided density of white noise of variance s^2 is s^2 / (rate / 2).
  const double density = 0.01;
  const auto rms = *band_rms(white_noise(density, 120'000, 7), kRate, kBands);
  for (std::size_t i = 1; i < kBands.size(); ++i) {
    const double expected = density * std::sqrt(kBands[i].to - kBands[i].from);
    EXPECT_NEAR(rms[i], expected, 0.06 * expected) << i;
  }
}

TEST(PowerSpectrum, TheBandsTogetherHoldTheVariance) {
  const std::vector<double> series = white_noise(0.01, 6400, 8);
  const std::vector<FrequencyBand> all = {{0.0, 200.0}};
  const auto whole = *band_rms(series, kRate, all);
  const auto parts = *band_rms(series, kRate, kBands);
  double sum = 0.0;
  for (const double part : parts) sum += part * part;
  EXPECT_NEAR(std::sqrt(sum), whole[0], 1e-12);
  EXPECT_NEAR(whole[0], 0.01 * std::sqrt(200.0), 0.005);
}

TEST(PowerSpectrum, TheHighestBandHoldsHalfTheSamplingRate) {
  std::vector<double> series;
  for (int i = 0; i < 6400; ++i) series.push_back(i % 2 == 0 ? 1.0 : -1.0);
  EXPECT_NEAR(band_rms(series, kRate, kBands)->back(), 1.0, 1e-6);
}

TEST(PowerSpectrum, OfTooLittleOrOfWhatIsNoNumberHasNoValue) {
  EXPECT_FALSE(band_rms({}, kRate, kBands));
  EXPECT_FALSE(band_rms(std::vector<double>(7, 1.0), kRate, kBands));
  std::vector<double> broken(800, 1.0);
  EXPECT_NEAR(band_rms(broken, kRate, kBands)->at(1), 0.0, 1e-12);
  broken[400] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(band_rms(broken, kRate, kBands));
}

TEST(SampleMinusMean, OfARampIsHalfTheIntervalLessHalfAStep) {
  std::vector<double> ramp;
  for (int i = 0; i < 803; ++i) ramp.push_back(0.5 * i);
  EXPECT_DOUBLE_EQ(*sample_minus_mean_rms(ramp, 8), 0.5 * 3.5);
  EXPECT_DOUBLE_EQ(*sample_minus_mean_rms(ramp, 1), 0.0);
}

TEST(SampleMinusMean, OfWhiteNoiseIsItsDeviationButForTheShareInTheMean) {
  const std::vector<double> noise = white_noise(1.0, 80'000, 9);
  const double sigma = std::sqrt(kRate / 2.0);
  const double expected = sigma * std::sqrt(7.0 / 8.0);
  EXPECT_NEAR(*sample_minus_mean_rms(noise, 8), expected, 0.03 * expected);
}

TEST(SampleMinusMean, WithoutAWholeIntervalHasNoValue) {
  EXPECT_FALSE(sample_minus_mean_rms(std::vector<double>(7, 1.0), 8));
  EXPECT_FALSE(sample_minus_mean_rms(std::vector<double>(7, 1.0), 0));
}

}  // namespace
}  // namespace aims
