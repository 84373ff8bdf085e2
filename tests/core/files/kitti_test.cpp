// SPDX-License-Identifier: BSD-3-Clause
#include "core/files/kitti.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace aims {
namespace {

std::string message_of(std::string_view text) {
  const auto parsed = parse_kitti(text, "p.txt");
  return parsed ? "" : parsed.error().message;
}

TEST(Kitti, TwelveNumbersAreTheRowsOfThePose) {
  // A quarter turn to the left: the body's x axis is the world's y axis.
  const auto poses = parse_kitti("# c\n0 -1 0 4 1 0 0 5 0 0 1 6\n1 0 0 0 0 1 0 0 0 0 1 0", "p.txt");
  ASSERT_TRUE(poses) << poses.error().message;
  ASSERT_EQ(poses->size(), 2U);
  EXPECT_EQ((*poses)[0].translation, Eigen::Vector3d(4.0, 5.0, 6.0));
  EXPECT_TRUE(((*poses)[0] * Eigen::Vector3d(1, 0, 0)).isApprox(Eigen::Vector3d(4, 6, 6)));
  EXPECT_NEAR(yaw_of((*poses)[0].rotation), M_PI / 2.0, 1e-12);
  EXPECT_TRUE((*poses)[1].R().isIdentity(1e-15));
}

TEST(Kitti, RoundedRotationsBecomeUnitQuaternions) {
  const auto poses = parse_kitti("0.707 -0.707 0 0 0.707 0.707 0 0 0 0 1 0", "p.txt");
  ASSERT_TRUE(poses) << poses.error().message;
  EXPECT_NEAR((*poses)[0].rotation.norm(), 1.0, 1e-15);
  EXPECT_NEAR(yaw_of((*poses)[0].rotation), M_PI / 4.0, 1e-9);
}

TEST(Kitti, ErrorsNameFileAndLine) {
  EXPECT_EQ(message_of("1 0 0 0 0 1 0 0 0 0 1 0\n1 0 0\n"),
            "p.txt:2: expected 12 columns, the rows of a 3x4 pose, found 3");
  EXPECT_EQ(message_of("1 0 0 x 0 1 0 0 0 0 1 0\n"),
            "p.txt:1: column 4: expected a finite number, found 'x'");
  EXPECT_EQ(message_of("1 0 0 nan 0 1 0 0 0 0 1 0\n"),
            "p.txt:1: column 4: expected a finite number, found 'nan'");
  EXPECT_NE(message_of("2 0 0 0 0 1 0 0 0 0 1 0\n").find("p.txt:1: expected a rotation"),
            std::string::npos);
  EXPECT_NE(message_of("-1 0 0 0 0 1 0 0 0 0 1 0\n").find("found a reflection"), std::string::npos);
}

TEST(Kitti, AsGivenKeepsAnInvalidPose) {
  const auto poses = parse_kitti("1 0 0 nan 0 1 0 0 0 0 1 0\n", "p.txt", PoseRules::kAsGiven);
  ASSERT_TRUE(poses) << poses.error().message;
  ASSERT_EQ(poses->size(), 1U);
  EXPECT_FALSE((*poses)[0].rotation.coeffs().allFinite());
  EXPECT_FALSE(parse_kitti("1 0 0 x 0 1 0 0 0 0 1 0\n", "p.txt", PoseRules::kAsGiven));
}

TEST(KittiTimes, AreExactNanosecondsAndIncrease) {
  const auto times = parse_times("0.0\n1.000000001\n# c\n\n2e0\r\n", "t.txt");
  ASSERT_TRUE(times) << times.error().message;
  EXPECT_EQ(*times, (std::vector<Time>{0, 1'000'000'001, 2 * kSecond}));
  const auto message = [](std::string_view text) {
    const auto parsed = parse_times(text, "t.txt");
    return parsed ? "" : parsed.error().message;
  };
  EXPECT_EQ(message("1\n1\n"), "t.txt:2: expected a stamp after 1.000000000, found 1.000000000");
  EXPECT_EQ(message("1 2\n"), "t.txt:1: expected one stamp in seconds, found '1 2'");
  EXPECT_EQ(message("x\n"), "t.txt:1: expected one stamp in seconds, found 'x'");
}

}  // namespace
}  // namespace aims
