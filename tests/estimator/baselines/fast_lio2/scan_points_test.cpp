// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/baselines/fast_lio2/scan_points.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace aims::fast_lio2 {
namespace {

constexpr Duration kPeriod = kSecond / 10;

LidarScan scan_of(std::vector<LidarPoint> points) {
  return {.stamp = kSecond, .end = kSecond + kPeriod, .points = std::move(points)};
}

LidarPoint point_at(const Eigen::Vector3f& position, Duration offset) {
  return {.position = position, .time_offset_ns = static_cast<std::int32_t>(offset)};
}

TEST(FastLio2Points, EveryNthThatIsFarEnoughIsSelected) {
  std::vector<LidarPoint> points;
  for (int i = 0; i < 12; ++i) {
    points.push_back(point_at({i < 6 ? 0.4F : 4.0F, 0.0F, 0.0F}, i));
  }
  points[9].position.x() = std::numeric_limits<float>::quiet_NaN();
  const LidarScan scan = scan_of(std::move(points));
  EXPECT_EQ(selected_points(scan, {.every_nth = 3, .min_range = 0.5}), (std::vector<int>{6}));
  EXPECT_EQ(selected_points(scan, {.every_nth = 3, .min_range = 0.1}), (std::vector<int>{0, 3, 6}));
}

TEST(FastLio2Points, TheScanEndsWithItsLastPointUnlessThePointsEndEarly) {
  const LidarScan scan = scan_of({point_at({1, 0, 0}, 0), point_at({1, 0, 0}, kPeriod / 4),
                                  point_at({1, 0, 0}, kPeriod - 1000)});
  EXPECT_EQ(end_of(scan, std::vector<int>{0, 1, 2}), scan.end - 1000);
  EXPECT_EQ(end_of(scan, std::vector<int>{0, 1}), scan.end);
  EXPECT_EQ(end_of(scan, {}), scan.end);
}

/// A body that turns and accelerates at constant rates, exactly as the knots assume between them.
struct Motion {
  Eigen::Vector3d rate{0.1, -0.3, 1.5};
  Eigen::Vector3d velocity{0.7, 0.2, -0.1};
  Eigen::Vector3d acceleration{1.0, -2.0, 0.5};

  Pose pose(double t) const {
    return {so3_exp(t * rate), t * velocity + 0.5 * t * t * acceleration};
  }
};

TEST(FastLio2Points, DeskewedPointsOfAMovingLidarMeetThoseOfAStandingOne) {
  const Motion motion;
  const Pose T_body_lidar{so3_exp({0.1, 0.2, -0.1}), {0.1, 0.0, 0.2}};
  State end;
  end.T_world_body = motion.pose(to_seconds(kPeriod));
  end.T_body_lidar = T_body_lidar;
  std::vector<Knot> knots;
  for (int i = 0; i <= 4; ++i) {
    const double t = 0.02 * i;
    knots.push_back({kSecond + from_seconds(t), motion.pose(t),
                     motion.velocity + t * motion.acceleration, motion.rate, motion.acceleration});
  }
  const Eigen::Vector3d landmark(3.0, -1.0, 0.7);
  LidarScan scan = scan_of({});
  std::vector<int> indices;
  for (int ms = 1; ms < 100; ms += 7) {
    const Pose T_world_lidar = motion.pose(1e-3 * ms) * T_body_lidar;
    indices.push_back(static_cast<int>(scan.points.size()));
    scan.points.push_back(
        point_at((T_world_lidar.inverse() * landmark).cast<float>(), ms * kMillisecond));
  }
  const Eigen::Vector3f expected =
      ((end.T_world_body * T_body_lidar).inverse() * landmark).cast<float>();
  for (const Eigen::Vector3f& point : deskewed(scan, indices, knots, end)) {
    EXPECT_LT((point - expected).norm(), 1e-5F);
  }
}

TEST(FastLio2Points, APointAtTheStartOfTheScanStaysAsItIs) {
  State end;
  end.T_world_body.translation.x() = 1.0;
  const std::vector<Knot> knots = {{kSecond, {}}, {kSecond + kPeriod / 2, {}}};
  const LidarScan scan = scan_of({point_at({3, 0, 0}, 0), point_at({3, 0, 0}, 1)});
  const auto points = deskewed(scan, std::vector<int>{0, 1}, knots, end);
  EXPECT_FLOAT_EQ(points[0].x(), 3.0F);
  EXPECT_FLOAT_EQ(points[1].x(), 2.0F);
}

}  // namespace
}  // namespace aims::fast_lio2
