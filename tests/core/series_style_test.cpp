// SPDX-License-Identifier: BSD-3-Clause
#include "core/series_style.hpp"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace aims {
namespace {

double linear(std::uint32_t byte) {
  const double value = byte / 255.0;
  return value <= 0.04045 ? value / 12.92 : std::pow((value + 0.055) / 1.055, 2.4);
}

Eigen::Vector3d linear_rgb(std::uint32_t rgb) {
  return {linear(rgb >> 16U & 0xFFU), linear(rgb >> 8U & 0xFFU), linear(rgb & 0xFFU)};
}

/// Oklab (B. Ottosson, 2020) of linear sRGB.
Eigen::Vector3d oklab(const Eigen::Vector3d& rgb) {
  Eigen::Matrix3d cones;
  cones << 0.4122214708, 0.5363325363, 0.0514459929,  //
      0.2119034982, 0.6806995451, 0.1073969566,       //
      0.0883024619, 0.2817188376, 0.6299787005;
  Eigen::Matrix3d lab;
  lab << 0.2104542553, 0.7936177850, -0.0040720468,  //
      1.9779984951, -2.4285922050, 0.4505937099,     //
      0.0259040371, 0.7827717662, -0.8086757660;
  return lab * (cones * rgb.cwiseMax(0.0).cwiseMin(1.0)).array().pow(1.0 / 3.0).matrix();
}

/// What eyes without red, green or blue cones see (Machado, Oliveira and Fernandes, 2009, severity
/// 1); the first is the normal eye.
std::array<Eigen::Matrix3d, 4> eyes() {
  std::array<Eigen::Matrix3d, 4> all;
  all[0].setIdentity();
  all[1] << 0.152286, 1.052583, -0.204868, 0.114503, 0.786281, 0.099216, -0.003882, -0.048116,
      1.051998;
  all[2] << 0.367322, 0.860646, -0.227968, 0.280085, 0.672501, 0.047413, -0.011820, 0.042940,
      0.968881;
  all[3] << 1.255528, -0.076749, -0.178779, -0.078411, 0.930809, 0.147602, 0.004733, 0.691367,
      0.303900;
  return all;
}

double contrast(double a, double b) { return (std::max(a, b) + 0.05) / (std::min(a, b) + 0.05); }

double luminance(const Eigen::Vector3d& rgb) {
  return rgb.dot(Eigen::Vector3d(0.2126, 0.7152, 0.0722));
}

TEST(SeriesStyle, TwelveColorsDifferForEveryKindOfEye) {
  for (const bool dark : {false, true}) {
    for (const Eigen::Matrix3d& eye : eyes()) {
      for (std::size_t i = 0; i < kSeriesColors; ++i) {
        for (std::size_t k = 0; k < i; ++k) {
          const auto seen = [&](std::size_t index) {
            const SeriesStyle style = series_style(index);
            return oklab(eye * linear_rgb(dark ? style.dark : style.light));
          };
          EXPECT_GT((seen(i) - seen(k)).norm(), 0.085) << i << " and " << k;
        }
      }
    }
  }
}

TEST(SeriesStyle, ColorsStandOutFromTheirGround) {
  const double dark_ground = luminance(linear_rgb(0x171b20));
  for (std::size_t i = 0; i < kSeriesColors; ++i) {
    const SeriesStyle style = series_style(i);
    EXPECT_GT(contrast(luminance(linear_rgb(style.light)), 1.0), 2.2) << i;
    EXPECT_GT(contrast(luminance(linear_rgb(style.dark)), dark_ground), 3.0) << i;
  }
}

TEST(SeriesStyle, EachTurnHasOtherDashes) {
  std::set<std::pair<std::uint32_t, LinePattern>> looks;
  for (std::size_t i = 0; i < kSeriesStyles; ++i) {
    const SeriesStyle style = series_style(i);
    EXPECT_TRUE(looks.emplace(style.light, style.pattern).second) << i;
    EXPECT_EQ(series_style(i + kSeriesStyles).light, style.light);
  }
}

TEST(SeriesStyle, AnEstimatorLooksTheSameInAnyCompany) {
  const std::vector<std::string> few = {"lio", "aims_d"};
  const std::vector<std::string> many = {"leg", "aims_d", "mine", "aims", "tfs_plus", "lio"};
  EXPECT_EQ(series_styles(few)[0], series_styles(many)[5]);
  EXPECT_EQ(series_styles(few)[1], series_styles(many)[1]);
}

TEST(SeriesStyle, LabelsOfAPictureDiffer) {
  std::vector<std::string> labels = {"aims_d", "aims_d+degeneracy.eta=5", "aims_d (optimized)",
                                     "mine", "yours"};
  const auto styles = series_styles(labels);
  EXPECT_EQ(std::set<std::size_t>(styles.begin(), styles.end()).size(), labels.size());
  EXPECT_EQ(series_style(styles[0]).light, series_style(styles[1]).light)
      << "a variant keeps its estimator's colour";
  while (labels.size() < kSeriesStyles) labels.push_back("x" + std::to_string(labels.size()));
  const auto all = series_styles(labels);
  EXPECT_EQ(std::set<std::size_t>(all.begin(), all.end()).size(), kSeriesStyles);
  labels.emplace_back("one too many");
  EXPECT_EQ(series_styles(labels).size(), labels.size());
}

}  // namespace
}  // namespace aims
