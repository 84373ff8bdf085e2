// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/baselines/lego_loam/range_image.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "estimator/baselines/lego_loam/segmented_features.hpp"
#include "tests/estimator/baselines/room_scan.hpp"

namespace aims::lego_loam {
namespace {

using aims::testing::room;
using aims::testing::scan_in;

constexpr double kColumn = 2.0 * std::numbers::pi / 1800.0;  ///< angle between two columns [rad]

const Pose kMiddle{Eigen::Quaterniond::Identity(), {0.3, -0.4, 0.6}};

LidarScan scan_of_room() { return scan_in(room(12.0, 9.0, 4.0), kMiddle); }

RangeImage image_of_room() { return {scan_of_room(), RangeImageConfig()}; }

/// A scan of single returns: ring, azimuth [rad] and range [m] of each.
struct Return {
  int ring;
  double azimuth;
  double range;
};
LidarScan scan_of(const std::vector<Return>& returns) {
  LidarScan scan;
  scan.end = 100;
  for (const Return& each : returns) {
    const double elevation = (2.0 * each.ring - 15.0) * std::numbers::pi / 180.0;
    const Eigen::Vector3d direction(std::cos(elevation) * std::cos(each.azimuth),
                                    std::cos(elevation) * std::sin(each.azimuth),
                                    std::sin(elevation));
    scan.points.push_back(
        {(each.range * direction).cast<float>(), 0.5F, 0, static_cast<std::uint16_t>(each.ring)});
  }
  return scan;
}

/// Column of an azimuth in an image of 1800 columns.
int column_of(double azimuth) {
  return static_cast<int>(std::lround(azimuth / (2.0 * std::numbers::pi) * 1800.0)) + 900;
}

TEST(LegoRangeImage, HasEachReturnInItsCell) {
  const RangeImage image = image_of_room();
  EXPECT_EQ(image.count(), 28800);
  for (int row = 0; row < 16; ++row) {
    for (int column = 0; column < 1800; ++column) {
      ASSERT_NE(image.kind(row, column), CellKind::kEmpty) << row << " " << column;
      EXPECT_EQ(image.point(row, column).ring, row);
      EXPECT_EQ(column_of(azimuth_of(image.point(row, column).position)) % 1800, column);
    }
  }
}

TEST(LegoRangeImage, GroundIsTheFloorAndNothingElse) {
  const RangeImage image = image_of_room();
  int ground = 0;
  for (int row = 0; row < 16; ++row) {
    for (int column = 0; column < 1800; ++column) {
      if (image.kind(row, column) != CellKind::kGround) continue;
      ++ground;
      EXPECT_NEAR((kMiddle * image.point(row, column).position.cast<double>()).z(), 0.0, 0.2);
    }
  }
  EXPECT_GT(ground, 3000);
}

TEST(LegoRangeImage, CeilingIsNoGround) {
  const RangeImage image = image_of_room();
  for (int row = 8; row < 16; ++row) {
    for (int column = 0; column < 1800; ++column) {
      EXPECT_NE(image.kind(row, column), CellKind::kGround);
    }
  }
}

TEST(LegoRangeImage, NearReturnsAreDropped) {
  EXPECT_EQ(RangeImage(scan_of({{8, 0.0, 0.9}, {8, 0.1, 1.1}}), RangeImageConfig()).count(), 1);
}

std::vector<Return> patch(int rows, int columns, double range) {
  std::vector<Return> returns;
  for (int row = 0; row < rows; ++row) {
    for (int i = 0; i < columns; ++i) returns.push_back({8 + row, i * kColumn, range});
  }
  return returns;
}

int count_of(const RangeImage& image, CellKind kind) {
  int count = 0;
  for (int row = 0; row < image.rows(); ++row) {
    for (int column = 0; column < image.columns(); ++column) {
      count += image.kind(row, column) == kind;
    }
  }
  return count;
}

TEST(LegoRangeImage, SmallPatchesAreOutliersUnlessTheySpanRings) {
  const RangeImageConfig config;
  EXPECT_EQ(count_of({scan_of(patch(1, 30, 4.0)), config}, CellKind::kSegment), 30);
  EXPECT_EQ(count_of({scan_of(patch(1, 20, 4.0)), config}, CellKind::kOutlier), 20);
  EXPECT_EQ(count_of({scan_of(patch(3, 2, 4.0)), config}, CellKind::kSegment), 6);
  EXPECT_EQ(count_of({scan_of(patch(2, 2, 4.0)), config}, CellKind::kOutlier), 4);
}

TEST(LegoRangeImage, AStepInRangeEndsASegment) {
  std::vector<Return> returns = patch(1, 60, 4.0);
  for (std::size_t i = 30; i < 60; ++i) returns[i].range = 4.1;
  EXPECT_EQ(count_of({scan_of(returns), RangeImageConfig()}, CellKind::kSegment), 60);
  returns.pop_back();
  EXPECT_EQ(count_of({scan_of(returns), RangeImageConfig()}, CellKind::kSegment), 30);
}

TEST(LegoFeatures, FlatPointsAreGroundAndEdgesAreNot) {
  const SegmentedFeatures found =
      segmented_features(image_of_room(), RangeImageConfig(), FeatureConfig());
  ASSERT_GT(found.features.flat.size(), 50U);
  for (const features::FeaturePoint& point : found.features.flat) {
    EXPECT_NEAR((kMiddle * point.position.cast<double>()).z(), 0.0, 0.2);
  }
  ASSERT_GT(found.features.sharp.size(), 20U);
  for (const features::FeaturePoint& point : found.features.sharp) {
    EXPECT_GT((kMiddle * point.position.cast<double>()).z(), 0.01);
  }
  EXPECT_GT(found.ground, 3000);
  EXPECT_GT(found.segmented, 10000);
}

TEST(LegoFeatures, OutliersLieAboveTheGroundRows) {
  std::vector<Return> returns;
  for (int column = 0; column < 1800; column += 3) {
    for (const int ring : {4, 12}) returns.push_back({ring, column * kColumn, 4.0});
  }
  const RangeImageConfig config;
  const SegmentedFeatures found =
      segmented_features(RangeImage(scan_of(returns), config), config, FeatureConfig());
  EXPECT_EQ(found.outliers.size(), 120U);  // every fifth column, of which every third has a return
  for (const features::FeaturePoint& point : found.outliers) EXPECT_EQ(point.ring, 12);
}

TEST(LegoAzimuthTimes, AreThoseOfTheTurnInFiringOrder) {
  constexpr double kPi = std::numbers::pi;
  AzimuthTimes times(kPi - 1e-3, -kPi + 1e-3);
  for (double fraction = 0.01; fraction < 0.99; fraction += 0.01) {
    EXPECT_NEAR(times.next(kPi * (1.0 - 2.0 * fraction)), fraction, 2e-3);
  }
}

TEST(LegoAzimuthTimes, InOrderOfColumnsTheFirstQuarterComesAfterTheEnd) {
  constexpr double kPi = std::numbers::pi;
  AzimuthTimes times(kPi - 1e-3, -kPi + 1e-3);
  for (double azimuth = -3.1; azimuth < 3.1; azimuth += 0.01) (void)times.next(azimuth);
  for (double azimuth = -3.1; azimuth < 3.1; azimuth += 0.01) {
    const double fraction = (kPi - azimuth) / (2.0 * kPi);
    const double expected = fraction < 0.249 ? fraction + 1.0 : fraction;
    const double found = times.next(azimuth);
    if (std::abs(fraction - 0.25) > 1e-3) {
      EXPECT_NEAR(found, expected, 2e-3);
    }
  }
}

}  // namespace
}  // namespace aims::lego_loam
