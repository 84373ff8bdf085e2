// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <memory>

#include "render/film/film.hpp"
#include "render/film/film_files.hpp"
#include "render/film/film_movie.hpp"
#include "render/film/map_growth.hpp"

namespace aims {
namespace {

/// A scan of one second whose returns all come from one place of the world, though the sensor
/// moves.
LidarScanPtr scan_of(const Eigen::Vector3d& p_world, const Trajectory& T_world_body,
                     const Pose& T_body_lidar, Time stamp) {
  auto scan = std::make_shared<LidarScan>();
  scan->stamp = stamp;
  scan->end = stamp + kSecond;
  for (int i = 0; i <= 100; ++i) {
    LidarPoint point;
    point.time_offset_ns = static_cast<std::int32_t>(i * 10 * kMillisecond);
    const Pose T_world_lidar = *pose_at(T_world_body, stamp + point.time_offset_ns) * T_body_lidar;
    point.position = (T_world_lidar.inverse() * p_world).cast<float>();
    scan->points.push_back(point);
  }
  return scan;
}

Trajectory turning_walk() {
  Trajectory trajectory;
  for (int i = 0; i <= 20; ++i) {
    StampedPose sample{i * 100 * kMillisecond, {}};
    sample.pose.translation = {0.1 * i, 0.02 * i, 0.0};
    sample.pose.rotation = yaw_rotation(0.05 * i);
    trajectory.push_back(sample);
  }
  return trajectory;
}

TEST(MapGrowth, PutsEachReturnWhereItCameFrom) {
  const Trajectory trajectory = turning_walk();
  const Pose T_body_lidar{yaw_rotation(0.4), {0.2, 0.0, 0.1}};
  const Eigen::Vector3d place(5.02, 1.02, 0.62);  // the middle of a cube of the map
  MapGrowth growth(T_body_lidar);
  growth.add(scan_of(place, trajectory, T_body_lidar, 0));
  growth.settle(trajectory);
  ASSERT_FALSE(growth.points().empty());
  for (const GrownPoint& point : growth.points()) {
    // The sensor moves by 1 mm and turns by 1 mrad in the 2 ms for which a pose serves.
    EXPECT_LT((point.position.cast<double>() - place).norm(), 0.01);
  }
  EXPECT_LE(growth.points().size(), 2U) << "one point per cube";
}

TEST(MapGrowth, WaitsUntilTheTrajectoryCoversTheScan) {
  const Trajectory trajectory = turning_walk();
  MapGrowth growth({}, {.every_scan = 1});
  growth.add(scan_of({5.0, 0.0, 0.0}, trajectory, {}, 500 * kMillisecond));
  growth.settle({trajectory.begin(), trajectory.begin() + 10});
  EXPECT_TRUE(growth.points().empty());
  growth.settle(trajectory);
  ASSERT_FALSE(growth.points().empty());
  EXPECT_GE(growth.points().front().seen, 500 * kMillisecond);
}

TEST(MapGrowth, KeepsReturnsOfPeopleInTheScanAloneAndNotInTheMap) {
  const Trajectory trajectory = turning_walk();
  const Eigen::Vector3d place(5.02, 1.02, 0.62);
  MapGrowth growth({}, {.every_scan = 1, .scan_returns = 20});
  const auto scan = scan_of(place, trajectory, {}, 0);
  growth.add(scan, std::vector<bool>(scan->points.size(), true));
  growth.settle(trajectory);
  EXPECT_TRUE(growth.points().empty());
  ASSERT_EQ(growth.scans().size(), 1U);
  EXPECT_EQ(growth.scans()[0].end, scan->end);
  EXPECT_LE(growth.scans()[0].points.size(), 20U);
  ASSERT_GE(growth.scans()[0].points.size(), 10U);
  for (const Eigen::Vector3f& p : growth.scans()[0].points) {
    EXPECT_LT((p.cast<double>() - place).norm(), 0.01);
  }
}

TEST(MovingReturns, AreThoseAtThePlaceOfAPersonWhenTheyWereFired) {
  const Trajectory trajectory = turning_walk();
  const Pose T_body_lidar{yaw_rotation(0.4), {0.2, 0.0, 0.1}};
  Scene scene;
  scene.people = {{.from = {5.0, 0.0}, .to = {5.0, 10.0}, .speed = 1.0, .start = 0.5}};
  // The axis of the person passes y = 1 half a second into the scan, and is 0.5 m away at its ends.
  const auto scan = scan_of({5.0, 1.0, 1.0}, trajectory, T_body_lidar, 0);
  const auto moving = moving_returns(*scan, scene, trajectory, T_body_lidar);
  ASSERT_EQ(moving.size(), scan->points.size());
  EXPECT_TRUE(moving[50]);
  EXPECT_FALSE(moving[0]);
  EXPECT_FALSE(moving[100]);
  const auto floor = scan_of({5.0, 1.0, 0.0}, trajectory, T_body_lidar, 0);
  for (const bool each : moving_returns(*floor, scene, trajectory, T_body_lidar)) {
    EXPECT_FALSE(each);
  }
  scene.people.clear();
  EXPECT_TRUE(moving_returns(*scan, scene, trajectory, T_body_lidar).empty());
}

TEST(MapGrowth, LeavesOutWhatIsFarAndWhatIsNone) {
  const Trajectory trajectory = turning_walk();
  auto scan = std::make_shared<LidarScan>();
  scan->end = kSecond;
  scan->points.resize(2);
  scan->points[0].position = {20.0F, 0.0F, 0.0F};
  scan->points[1].position = {std::nanf(""), 0.0F, 0.0F};
  MapGrowth growth({}, {.reach = 15.0F});
  growth.add(scan);
  growth.settle(trajectory);
  EXPECT_TRUE(growth.points().empty());
}

TEST(Film, SpansTheWalkWithoutTheStanding) {
  FilmedSequence sequence;
  for (int i = 0; i <= 100; ++i) {
    StampedPose sample{i * 100 * kMillisecond, {}};
    sample.pose.translation.x() = std::clamp(0.1 * (i - 30), 0.0, 4.0);
    sequence.truth.push_back(sample);
  }
  const FilmSpan span = motion_span(sequence);
  EXPECT_NEAR(to_seconds(span.begin), 3.2, 0.2);
  EXPECT_NEAR(to_seconds(span.end), 6.8, 0.2);
}

TEST(Film, SaysWhyThereIsNone) {
  const FilmedSequence nothing;
  const auto film = Film::create(nothing, {});
  ASSERT_FALSE(film);
  EXPECT_NE(film.error().message.find("no snapshot"), std::string::npos);
}

TEST(FilmOptions, SizesAreReadStrictly) {
  const auto size = parse_picture_size("1280x720");
  ASSERT_TRUE(size);
  EXPECT_EQ(size->width, 1280);
  EXPECT_EQ(size->height, 720);
  for (const char* bad : {"", "640", "640x", "x400", "640x400x3", "640 x400", "12x12", "-640x400",
                          "99999999999x400", "640x5000"}) {
    const auto refused = parse_picture_size(bad);
    ASSERT_FALSE(refused) << bad;
    EXPECT_NE(refused.error().message.find("WIDTHxHEIGHT"), std::string::npos);
  }
}

TEST(FilmOptions, WhatCannotBeMetIsRefused) {
  const auto message = [](const FilmOptions& options) {
    const auto checked = check(options);
    return checked ? std::string() : checked.error().message;
  };
  FilmOptions options;
  EXPECT_EQ(message(options), "");
  options.video = "walk.webp";
  EXPECT_EQ(message(options), "");
  options.video = "walk.gif";
  EXPECT_NE(message(options).find(".webp, .mp4 or .webm"), std::string::npos);
  options.video = "there/walk.webp";
  EXPECT_NE(message(options).find("without a folder"), std::string::npos);
  options.video = "walk.mp4";
  options.video_size = {641, 400};
  EXPECT_NE(message(options).find("even"), std::string::npos);
  options.video = "walk.webp";
  options.seconds = 600.0;
  EXPECT_NE(message(options).find("frames"), std::string::npos);
}

}  // namespace
}  // namespace aims
