// SPDX-License-Identifier: BSD-3-Clause
#include "core/files/tum.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>
// rapidcheck's gtest glue needs both headers above it.
#include <rapidcheck/gtest.h>

#include <cmath>
#include <set>

#include "tests/support/temporary_folder.hpp"

namespace aims {
namespace {

std::string message_of(std::string_view text) {
  const auto parsed = parse_tum(text, "t.tum");
  return parsed ? "" : parsed.error().message;
}

TEST(Tum, WritesOneLinePerPose) {
  const Trajectory trajectory = {
      {1'500'000'001, {Eigen::Quaterniond(0.5, -0.5, 0.5, 0.5), {1.0, -2.25, 3.0}}}};
  EXPECT_EQ(tum_text(trajectory), "1.500000001 1 -2.25 3 -0.5 0.5 0.5 0.5\n");
  EXPECT_EQ(tum_text(Trajectory{{-1, Pose()}}), "-0.000000001 0 0 0 0 0 0 1\n");
  EXPECT_EQ(tum_text({}), "");
}

TEST(Tum, ReadsCommentsBlanksAndOtherNotations) {
  const auto parsed = parse_tum("# header\n\n  1.5\t1 2 3 0 0 0 1\r\n2e0 1 2 3 0 0 0 1", "t.tum");
  ASSERT_TRUE(parsed) << parsed.error().message;
  ASSERT_EQ(parsed->size(), 2U);
  EXPECT_EQ((*parsed)[0].stamp, 1'500'000'000);
  EXPECT_EQ((*parsed)[1].stamp, 2 * kSecond);
  EXPECT_EQ((*parsed)[0].pose.translation, Eigen::Vector3d(1.0, 2.0, 3.0));
}

TEST(Tum, ErrorsNameFileAndLine) {
  EXPECT_EQ(message_of("1 0 0 0 0 0 0 1\n2 0 0 0 0 0 1\n"),
            "t.tum:2: expected 8 columns 'stamp x y z qx qy qz qw', found 7");
  EXPECT_EQ(message_of("x 0 0 0 0 0 0 1\n"), "t.tum:1: expected a stamp in seconds, found 'x'");
  EXPECT_EQ(message_of("1e300 0 0 0 0 0 0 1\n"),
            "t.tum:1: expected a stamp in seconds, found '1e300'");
  EXPECT_EQ(message_of("1700000000123456789 0 0 0 0 0 0 1\n"),
            "t.tum:1: expected a stamp in seconds, found '1700000000123456789', likely in ns");
  EXPECT_EQ(message_of("1 nan 0 0 0 0 0 1\n"),
            "t.tum:1: column 2: expected a finite number, found 'nan'");
  EXPECT_EQ(message_of("1 0 0 0 0 0 0 2\n"),
            "t.tum:1: expected a quaternion of norm 1, found norm 2");
  EXPECT_EQ(message_of("# c\n2 0 0 0 0 0 0 1\n2 0 0 0 0 0 0 1\n"),
            "t.tum:3: expected a stamp after 2.000000000, found 2.000000000");
}

TEST(Tum, AsGivenKeepsInvalidPoses) {
  const auto parsed = parse_tum("2 nan 0 0 0 0 0 1\n2 0 0 0 0 0 0 0\n1 0 0 0 0 0 0 0.9999\n",
                                "t.tum", PoseRules::kAsGiven);
  ASSERT_TRUE(parsed) << parsed.error().message;
  ASSERT_EQ(parsed->size(), 3U);
  EXPECT_TRUE(std::isnan((*parsed)[0].pose.translation.x()));
  EXPECT_EQ((*parsed)[1].pose.rotation.norm(), 0.0);
  EXPECT_EQ((*parsed)[2].pose.rotation.norm(), 1.0) << "rounding is made good";
  EXPECT_FALSE(parse_tum("1 x 0 0 0 0 0 1\n", "t.tum", PoseRules::kAsGiven));
}

TEST(Tum, MissingFileIsNamed) {
  const auto read = read_tum("/nonexistent/t.tum");
  ASSERT_FALSE(read);
  EXPECT_EQ(read.error().message, "/nonexistent/t.tum: cannot be read: No such file or directory");
}

RC_GTEST_PROP(Tum, RoundTripIsExact, ()) {
  const auto stamps = *rc::gen::container<std::set<Time>>(
      rc::gen::inRange<Time>(-9'000'000'000'000'000'000, 9'000'000'000'000'000'000));
  const auto number = rc::gen::suchThat(rc::gen::arbitrary<double>(),
                                        [](double each) { return std::isfinite(each); });
  Trajectory trajectory;
  for (const Time stamp : stamps) {
    const auto angle = *rc::gen::inRange(-3'000'000, 3'000'000);
    trajectory.push_back(
        {stamp,
         {so3_exp(Eigen::Vector3d(1e-6, 0.7e-6, -0.2e-6) * angle), {*number, *number, *number}}});
  }
  const auto again = parse_tum(tum_text(trajectory), "t.tum");
  if (!again) RC_FAIL(again.error().message);
  RC_ASSERT(again->size() == trajectory.size());
  for (std::size_t i = 0; i < trajectory.size(); ++i) {
    RC_ASSERT((*again)[i].stamp == trajectory[i].stamp);
    RC_ASSERT((*again)[i].pose.translation == trajectory[i].pose.translation);
    RC_ASSERT((*again)[i].pose.rotation.coeffs() == trajectory[i].pose.rotation.coeffs());
  }
}

TEST(Tum, FilesRoundTrip) {
  const TemporaryFolder directory;
  const Trajectory trajectory = {{0, Pose()}, {kSecond, {yaw_rotation(1.0), {1.0, 2.0, 3.0}}}};
  const auto file = directory.path() / "t.tum";
  ASSERT_TRUE(write_tum(file, trajectory));
  const auto again = read_tum(file);
  ASSERT_TRUE(again) << again.error().message;
  EXPECT_EQ(tum_text(*again), tum_text(trajectory));
}

}  // namespace
}  // namespace aims
