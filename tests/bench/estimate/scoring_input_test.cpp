// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>

#include "bench/estimate/scoring_input.hpp"
#include "bench/scenario/scenario.hpp"
#include "bench/scoring/trajectory_summary.hpp"
#include "core/files/tum.hpp"
#include "recordings/bag/bag_writer.hpp"
#include "recordings/messages/message_encoding.hpp"
#include "recordings/messages/message_types.hpp"
#include "tests/support/temporary_folder.hpp"

namespace aims {
namespace {

constexpr const char* kWaypointTimes = "point,stamp_s\na,1\nb,4\na,9\n";

/// A bend in space, sampled at 10 Hz over ten seconds.
Trajectory bend() {
  Trajectory trajectory;
  for (int i = 0; i <= 100; ++i) {
    const double t = 0.1 * i;
    trajectory.push_back({from_seconds(t),
                          {so3_exp(Eigen::Vector3d(0.02 * t, -0.05 * t, 0.2 * t)),
                           Eigen::Vector3d(t, 0.1 * t * t, 0.3 + 0.05 * std::sin(t))}});
  }
  return trajectory;
}

std::string kitti_text(const Trajectory& trajectory) {
  std::string text;
  for (const StampedPose& each : trajectory) {
    const Eigen::Matrix3d R = each.pose.R();
    for (int row = 0; row < 3; ++row) {
      text += fmt::format("{} {} {} {}{}", R(row, 0), R(row, 1), R(row, 2),
                          each.pose.translation[row], row < 2 ? " " : "\n");
    }
  }
  return text;
}

std::string times_text(const Trajectory& trajectory) {
  std::string text;
  for (const StampedPose& each : trajectory) text += fmt::format("{}\n", to_seconds(each.stamp));
  return text;
}

class ScoringInputs : public ::testing::Test {
 protected:
  std::string file(const std::string& name, const std::string& text) const {
    const auto path = folder_.path() / name;
    std::ofstream(path) << text;
    return path.string();
  }

  std::string bag(const Trajectory& trajectory) const {
    const auto path = folder_.path() / "run.bag";
    auto writer = BagWriter::create(path);
    const auto odometry = writer->add_connection("/odom", odometry_type());
    const auto waypoint_times = writer->add_connection("/aims/waypoint_times", string_type());
    for (const StampedPose& each : trajectory) {
      const auto message = odometry_message({0, each.stamp, "world"}, "imu", {each.pose, {}, {}});
      EXPECT_TRUE(writer->write(odometry, kSecond + each.stamp, message.view()));
    }
    EXPECT_TRUE(writer->write(waypoint_times, 20 * kSecond, string_message(kWaypointTimes).view()));
    EXPECT_TRUE(writer->close());
    return path.string();
  }

  static std::string message_of(const ScoringRequest& request) {
    const auto input = read_scoring_input(request);
    return input ? "" : input.error().message;
  }

  /// A request that needs nothing more.
  ScoringRequest plain() const {
    ScoringRequest request;
    request.truth = file("truth.tum", tum_text(bend()));
    request.estimates = {file("mine.tum", tum_text(bend()))};
    return request;
  }

  TemporaryFolder folder_;
};

TEST_F(ScoringInputs, NumbersOfFramesTakeTheStampsOfTheirFile) {
  const Trajectory truth = bend();
  Trajectory frames = truth;
  frames.resize(truth.size() - 3);  // it ended early
  for (std::size_t i = 0; i < frames.size(); ++i) {
    frames[i].stamp = static_cast<Time>(i) * kSecond;
  }
  ScoringRequest request;
  request.truth = file("truth.tum", tum_text(truth));
  request.estimates = {file("frames.txt", tum_text(frames))};
  request.times = file("times.txt", times_text(truth));
  const auto input = read_scoring_input(request);
  ASSERT_TRUE(input) << input.error().message;
  EXPECT_EQ(input->estimates[0].trajectory.back().stamp, truth[frames.size() - 1].stamp);
  EXPECT_NE(input->notes.at(0).find("its stamps are numbers of frames"), std::string::npos);
  request.times = file("few.txt", "0\n0.1\n0.2\n");
  EXPECT_NE(message_of(request).find("has a pose of frame 97, but"), std::string::npos)
      << message_of(request);
}

TEST_F(ScoringInputs, OfADamagedRecordingACopyIsAdvised) {
  ScoringRequest request;
  request.truth = bag(bend());
  request.estimates = {file("e.tum", tum_text(bend()))};
  std::filesystem::resize_file(request.truth, std::filesystem::file_size(request.truth) - 100);
  EXPECT_NE(message_of(request).find("(aims convert IN --recover --out COPY; then score the copy)"),
            std::string::npos)
      << message_of(request);
}

TEST_F(ScoringInputs, NoCopyIsAdvisedByTheWordsOfAPath) {
  ScoringRequest request;
  request.truth = file("; --recover reads.bag", "no bag");
  request.estimates = {file("e.tum", tum_text(bend()))};
  EXPECT_NE(message_of(request).find("reads.bag: at byte 0: "), std::string::npos)
      << message_of(request);
  EXPECT_EQ(message_of(request).find("aims convert"), std::string::npos);
}

TEST_F(ScoringInputs, WaypointTimesOfARunAreScoredOverItsScenariosSegments) {
  // As on the garage: from a to d and from d to h, past the points between.
  const std::string times = "point,stamp_s\na,0\nb,2\nd,4\nf,5\nh,7\nd,8\na,9\n";
  const std::string config = "scoring: {segments: [a-d, d-h, h-d, d-a]}\n";
  ScoringRequest request = plain();
  request.waypoint_times = file("waypoint_times.csv", times);
  const auto names_of = [](const ScoringInput& input) {
    std::vector<std::string> names;
    for (const Segment& each : input.segments) names.push_back(each.name);
    return names;
  };
  EXPECT_EQ(names_of(*read_scoring_input(request)).size(), 6U) << "nothing states other segments";
  file("config.yaml", config);
  const auto stated = read_scoring_input(request);
  ASSERT_TRUE(stated) << stated.error().message;
  EXPECT_EQ(names_of(*stated), (std::vector<std::string>{"a-d", "d-h", "h-d", "d-a"}));
  ASSERT_EQ(stated->notes.size(), 1U);
  EXPECT_NE(stated->notes[0].find("segments a-d, d-h, h-d, d-a: as "), std::string::npos);
  request.scoring.segments = {"a-d"};
  EXPECT_EQ(names_of(*read_scoring_input(request)), std::vector<std::string>{"a-d"});
  request.scoring.segments.clear();
  request.segments = "d-h";
  EXPECT_EQ(names_of(*read_scoring_input(request)), std::vector<std::string>{"d-h"});
  request.segments.clear();
  file("config.yaml", "of: another version\n");
  EXPECT_EQ(names_of(*read_scoring_input(request)).size(), 6U);
}

TEST_F(ScoringInputs, TumKittiAndBagGiveTheSameScores) {
  Trajectory drifting = bend();
  for (StampedPose& each : drifting) each.pose.translation *= 1.03;
  ScoringRequest request;
  request.truth = file("truth.tum", tum_text(bend()));
  request.estimates = {file("mine.tum", tum_text(drifting)), file("mine.txt", kitti_text(drifting)),
                       bag(drifting)};
  request.times = file("times.txt", times_text(drifting));
  request.waypoint_times = file("waypoint_times.csv", kWaypointTimes);
  const auto input = read_scoring_input(request);
  ASSERT_TRUE(input) << input.error().message;
  const auto scores = score_trajectories(*input);
  ASSERT_TRUE(scores) << scores.error().message;
  const Scores& tum = scores->estimates[0].scores;
  EXPECT_NEAR(*tum.m_list_percent, 3.0, 1e-9);
  ASSERT_EQ(tum.segments.size(), 2U);
  for (const std::size_t i : {1U, 2U}) {
    const Scores& other = scores->estimates[i].scores;
    SCOPED_TRACE(scores->estimates[i].given.kind);
    EXPECT_NEAR(*other.m_list_percent, *tum.m_list_percent, 1e-9);
    EXPECT_NEAR(*other.ate_m, *tum.ate_m, 1e-12);
    EXPECT_NEAR(*other.ate_se3_m, *tum.ate_se3_m, 1e-12);
    EXPECT_NEAR(*other.rpe[0].rotation_rmse_rad, *tum.rpe[0].rotation_rmse_rad, 1e-7);
    EXPECT_EQ(other.poses_compared, tum.poses_compared);
  }
  EXPECT_EQ(scores->estimates[1].given.kind, "KITTI poses");
  EXPECT_EQ(scores->estimates[2].given.name, "run/odom");
}

TEST_F(ScoringInputs, ATruthInABagBringsItsWaypointTime) {
  ScoringRequest request = plain();
  request.truth = bag(bend());
  const auto input = read_scoring_input(request);
  ASSERT_TRUE(input) << input.error().message;
  ASSERT_EQ(input->segments.size(), 2U);
  EXPECT_EQ(input->segments[1].name, "b-a");
  EXPECT_EQ(input->segments[1].end, 9 * kSecond);
}

TEST_F(ScoringInputs, KittiPosesTakeTheStampsOfATruthOfTheSameLength) {
  ScoringRequest request = plain();
  request.estimates = {file("mine.txt", kitti_text(bend()))};
  const auto input = read_scoring_input(request);
  ASSERT_TRUE(input) << input.error().message;
  EXPECT_EQ(input->estimates[0].trajectory[7].stamp, 700 * kMillisecond);
  const auto said = [&](const char* words) {
    return std::any_of(input->notes.begin(), input->notes.end(), [&](const std::string& note) {
      return note.find(words) != std::string::npos;
    });
  };
  EXPECT_TRUE(said("take the stamps of the truth"));
  EXPECT_TRUE(said("taken with z up"));
  request.truth = request.estimates[0];
  EXPECT_NE(message_of(request).find("--times"), std::string::npos) << "a truth has to have stamps";
}

TEST_F(ScoringInputs, TheExtrinsicTurnsThePosesOfAnotherFrameIntoTheBodys) {
  const Pose T_body_lidar = {so3_exp(Eigen::Vector3d(0.1, 0.4, -1.2)), {0.2, -0.1, 0.15}};
  Trajectory of_lidar = bend();
  for (StampedPose& each : of_lidar) each.pose = each.pose * T_body_lidar;
  ScoringRequest request = plain();
  request.estimates = {file("lidar.tum", tum_text(of_lidar))};
  const auto& q = T_body_lidar.rotation;
  request.extrinsic = fmt::format("0.2 -0.1 0.15 {} {} {} {}", q.x(), q.y(), q.z(), q.w());
  const auto input = read_scoring_input(request);
  ASSERT_TRUE(input) << input.error().message;
  EXPECT_LT(*score_trajectories(*input)->estimates[0].scores.ate_m, 1e-12);
  request.extrinsic.clear();
  EXPECT_GT(*score_trajectories(*read_scoring_input(request))->estimates[0].scores.ate_m, 0.05);
}

TEST_F(ScoringInputs, TheTimeOffsetIsAddedToTheEstimates) {
  Trajectory late = bend();
  for (StampedPose& each : late) each.stamp += 1000 * kSecond;
  ScoringRequest request = plain();
  request.estimates = {file("late.tum", tum_text(late))};
  EXPECT_FALSE(score_trajectories(*read_scoring_input(request)));
  request.time_offset_s = -1000.0;
  EXPECT_EQ(score_trajectories(*read_scoring_input(request))->estimates[0].scores.ate_m, 0.0);
}

TEST_F(ScoringInputs, StampsOfAnotherUnitAreNamedAndRead) {
  const auto text_in = [](double seconds, double begin) {
    std::string text = "# stamp x y z q\n";
    for (const StampedPose& each : bend()) {
      const Eigen::Vector3d& p = each.pose.translation;
      const auto& q = each.pose.rotation;
      text +=
          fmt::format("{:.0f} {} {} {} {} {} {} {}\n", (begin + to_seconds(each.stamp)) / seconds,
                      p.x(), p.y(), p.z(), q.x(), q.y(), q.z(), q.w());
    }
    return text;
  };
  ScoringRequest request = plain();
  request.estimates = {file("ms.tum", text_in(1e-3, 0.0))};
  const auto scored = score_trajectories(*read_scoring_input(request));
  ASSERT_TRUE(scored) << scored.error().message;
  EXPECT_NE(std::ranges::find_if(scored->notes,
                                 [](const std::string& note) {
                                   return note.find("--stamp-unit ms reads") != std::string::npos;
                                 }),
            scored->notes.end());
  request.stamp_unit = "ms";
  EXPECT_LT(*score_trajectories(*read_scoring_input(request))->estimates[0].scores.ate_m, 1e-12);
  request.estimates = {file("us.tum", text_in(1e-6, 1.7e9))};
  request.stamp_unit = "us";
  request.time_offset_s = -1.7e9;
  EXPECT_LT(*score_trajectories(*read_scoring_input(request))->estimates[0].scores.ate_m, 1e-12);
}

TEST_F(ScoringInputs, QuaternionsWithWFirstAreNamedOnEitherSide) {
  // x y z w of the text are w x y z of the pose.
  Trajectory written = bend();
  for (StampedPose& each : written) {
    const Eigen::Quaterniond q = each.pose.rotation;
    each.pose.rotation = Eigen::Quaterniond(q.z(), q.w(), q.x(), q.y());
  }
  const std::string w_first = file("w_first.tum", tum_text(written));
  ScoringRequest of_truth = plain(), of_estimate = plain();
  of_truth.truth = w_first;
  of_estimate.estimates = {w_first};
  for (const ScoringRequest& request : {of_truth, of_estimate}) {
    const auto scored = score_trajectories(*read_scoring_input(request));
    ASSERT_TRUE(scored);
    EXPECT_TRUE(std::ranges::any_of(scored->notes, [](const std::string& note) {
      return note.find("quaternions are read as w, x, y, z") != std::string::npos;
    }));
  }
}

TEST_F(ScoringInputs, PositionsInAnotherUnitAndInverseAttitudesAreNamed) {
  Trajectory millimetres = bend(), inverse = bend();
  for (StampedPose& each : millimetres) each.pose.translation *= 1e3;
  for (StampedPose& each : inverse) each.pose.rotation = each.pose.rotation.conjugate();
  const auto names = [](const ScoringRequest& request, const std::string& text) {
    const auto scored = score_trajectories(*read_scoring_input(request));
    EXPECT_TRUE(scored);
    return std::ranges::any_of(scored->notes, [&](const std::string& note) {
      return note.find(text) != std::string::npos;
    });
  };
  EXPECT_FALSE(names(plain(), "likely in") || names(plain(), "quaternions"));
  for (const bool of_truth : {true, false}) {
    const auto with = [&](const Trajectory& other) {
      ScoringRequest request = plain();
      const std::string other_file = file("other.tum", tum_text(other));
      of_truth ? request.truth = other_file : request.estimates.front() = other_file;
      return request;
    };
    EXPECT_TRUE(names(with(millimetres), "likely in mm"));
    EXPECT_TRUE(names(with(inverse), "quaternions are conjugated"));
  }
  ScoringRequest far = plain();
  far.extrinsic = "1e308 0 0 0 0 0 1";
  EXPECT_NE(message_of(far).find("expected at most 100 m"), std::string::npos);
}

TEST_F(ScoringInputs, ATurnedBodyFrameIsNamedWithTheExtrinsicThatCorrectsIt) {
  const Pose T_body_estimate = {so3_exp(Eigen::Vector3d(0.0, 0.0, 0.5 * std::numbers::pi)),
                                Eigen::Vector3d::Zero()};
  Trajectory turned = bend();
  for (StampedPose& each : turned) each.pose = each.pose * T_body_estimate;
  ScoringRequest request = plain();
  request.estimates = {file("turned.tum", tum_text(turned))};
  const auto scored = score_trajectories(*read_scoring_input(request));
  ASSERT_TRUE(scored);
  const auto hint = std::ranges::find_if(scored->notes, [](const std::string& note) {
    return note.find("turned by 90 deg about z") != std::string::npos;
  });
  ASSERT_NE(hint, scored->notes.end());
  constexpr std::string_view kOption = "--extrinsic '";
  const std::size_t begin = hint->find(kOption) + kOption.size();
  request.extrinsic = hint->substr(begin, hint->find('\'', begin) - begin);
  const auto again = score_trajectories(*read_scoring_input(request));
  EXPECT_LT(*again->estimates[0].scores.ate_m, 1e-4) << request.extrinsic;
  for (const std::string& note : again->notes) EXPECT_EQ(note.find("turned by"), std::string::npos);
  request.extrinsic = "0 0 0 0 0 -0.70711 0.70711";  // the wrong way round
  const auto wrong = score_trajectories(*read_scoring_input(request));
  EXPECT_TRUE(std::ranges::any_of(wrong->notes, [](const std::string& note) {
    return note.find("--extrinsic '0 0 0 0 0 0.7071 0.7071'") != std::string::npos;
  })) << "what is given already counts";
}

TEST_F(ScoringInputs, EstimatesOfOneNameAreNumbered) {
  ScoringRequest request = plain();
  request.estimates.push_back(request.estimates[0]);
  const auto input = read_scoring_input(request);
  ASSERT_TRUE(input);
  EXPECT_EQ(input->estimates[0].name, "mine");
  EXPECT_EQ(input->estimates[1].name, "mine#2");
  request.names = {"first", "second"};
  EXPECT_EQ(read_scoring_input(request)->estimates[1].name, "second");
  request.names = {"first"};
  EXPECT_NE(message_of(request).find("--name: expected one for each of 2"), std::string::npos);
}

TEST_F(ScoringInputs, OnlyTheScoringOfAConfigurationCounts) {
  const std::string config = file("run.yaml", "lidar: {range_max: 30}\nscoring: {max_gap: 7}\n");
  const auto scoring_with = [&](const std::string& setting) {
    return scoring_config(config, std::vector<std::string>{setting});
  };
  const auto scoring = scoring_with("scoring.anchor=pose");
  ASSERT_TRUE(scoring) << scoring.error().message;
  EXPECT_EQ(scoring->max_gap, 7.0);
  EXPECT_EQ(scoring->anchor, AlignmentKind::kStartPose);
  EXPECT_NE(
      scoring_with("scoring.ancor=pose").error().message.find("did you mean 'scoring.anchor'?"),
      std::string::npos);
  EXPECT_NE(scoring_with("lidar.range_max=3").error().message.find("unknown key 'lidar.range_max'"),
            std::string::npos);
}

std::string positions_text(const Trajectory& trajectory, const Eigen::Vector3d& lever) {
  std::string text = "#timestamp, x, y, z\n";
  for (const StampedPose& each : trajectory) {
    const Eigen::Vector3d p = each.pose * lever;
    text +=
        fmt::format("{}, {}, {}, {}\n", each.stamp + 1'600'000'000 * kSecond, p.x(), p.y(), p.z());
  }
  return text;
}

TEST_F(ScoringInputs, APrismIsReachedByALeverArmGivenOrFitted) {
  ScoringRequest request;
  request.truth = file("prism.csv", positions_text(bend(), {0.1, 0.2, 0.5}));
  request.estimates = {file("mine.tum", tum_text(bend()))};
  request.time_offset_s = 1'600'000'000.0;
  const auto off = score_trajectories(*read_scoring_input(request));
  ASSERT_TRUE(off) << off.error().message;
  EXPECT_GT(off->estimates[0].scores.ate_yaw_m.value(), 0.02);
  EXPECT_FALSE(off->estimates[0].scores.heading_error_rad);
  request.lever_arm = "0.1 0.2 0.5";
  const auto given = score_trajectories(*read_scoring_input(request));
  EXPECT_NEAR(given->estimates[0].scores.ate_yaw_m.value(), 0.0, 1e-9);
  request.lever_arm = "estimate";
  const auto fitted = score_trajectories(*read_scoring_input(request));
  EXPECT_NEAR(fitted->estimates[0].scores.ate_yaw_m.value(), 0.0, 1e-6);
  request.lever_arm = "0.1 0.2";
  EXPECT_NE(message_of(request).find("--lever-arm '0.1 0.2': expected 'x y z' in metres"),
            std::string::npos);
}

TEST_F(ScoringInputs, APoseOfTheEndIsATruthOfItsOwn) {
  ScoringRequest request = plain();
  request.truth.clear();
  const Pose T_start_end = bend().front().pose.inverse() * bend().back().pose;
  const Eigen::Quaterniond& q = T_start_end.rotation;
  const Eigen::Vector3d p = T_start_end.translation + Eigen::Vector3d(0.0, 0.3, 0.4);
  request.end_pose =
      fmt::format("{} {} {} {} {} {} {}", p.x(), p.y(), p.z(), q.x(), q.y(), q.z(), q.w());
  const auto scores = score_trajectories(*read_scoring_input(request));
  ASSERT_TRUE(scores) << scores.error().message;
  EXPECT_NEAR(scores->estimates[0].scores.m_end.value().norm_m, 0.5, 1e-9);
  const Scores& of_end = scores->estimates[0].scores;
  EXPECT_FALSE(of_end.judged) << "the truth says nothing of the way";
  EXPECT_FALSE(of_end.ate_yaw_m || of_end.ate_m || of_end.ate_se3_m || of_end.max_error_m);
  EXPECT_FALSE(of_end.control_points || of_end.drift);
  EXPECT_TRUE(scores_json(of_end)["success"].is_null());
  EXPECT_NE(to_text(trajectory_score_table(*scores)).find("M_end"), std::string::npos);
  request.end_pose = "0 0 0";  // a closed route, which the bend is not
  const auto closed = score_trajectories(*read_scoring_input(request));
  EXPECT_NEAR(closed->estimates[0].scores.m_end.value().norm_m, T_start_end.translation.norm(),
              1e-9);
  request.truth = plain().truth;
  EXPECT_NE(message_of(request).find("--truth or --end-pose"), std::string::npos);
}

TEST_F(ScoringInputs, ALeverArmMayBeInAFrameOfTheBody) {
  const Pose T_imu_lidar{Eigen::Quaterniond(0, 1, 0, 0), {0.1, -0.2, 0.3}};
  const Eigen::Vector3d in_lidar(0.03, -0.05, 0.28);
  Trajectory prism = bend();
  for (StampedPose& each : prism) {
    each.pose.translation = each.pose * (T_imu_lidar * in_lidar);
    each.pose.rotation.setIdentity();
  }
  ScoringRequest request = plain();
  request.truth = file("prism.tum", tum_text(prism));
  request.lever_arm = "0.03 -0.05 0.28";
  request.lever_frame = "0.1 -0.2 0.3 1 0 0 0";
  const auto scores = score_trajectories(*read_scoring_input(request));
  ASSERT_TRUE(scores) << scores.error().message;
  EXPECT_LT(scores->estimates[0].scores.ate_se3_m.value(), 1e-6);
  request.lever_frame.clear();
  const auto elsewhere = score_trajectories(*read_scoring_input(request));
  EXPECT_GT(elsewhere->estimates[0].scores.ate_se3_m.value(), 0.05);
}

TEST_F(ScoringInputs, PositionsWrittenAsPosesAndFewPointsAreRecognized) {
  ScoringRequest request = plain();
  Trajectory level = bend();
  for (StampedPose& each : level) each.pose.rotation.setIdentity();
  request.truth = file("station.tum", tum_text(level));
  auto input = read_scoring_input(request);
  ASSERT_TRUE(input) << input.error().message;
  EXPECT_EQ(input->scoring.truth, TruthContent::kPosition);
  EXPECT_EQ(input->scoring.association, Association::kInterpolated);
  Trajectory few;
  for (std::size_t i = 0; i < level.size(); i += 25) few.push_back(level[i]);
  request.truth = file("points.tum", tum_text(few));
  input = read_scoring_input(request);
  EXPECT_EQ(input->scoring.association, Association::kAtTruth);
  EXPECT_EQ(input->scoring.truth, TruthContent::kPose) << "five attitudes may be the same";
  EXPECT_EQ(read_scoring_input(plain())->scoring.truth, TruthContent::kPose);
}

TEST_F(ScoringInputs, BadArgumentsAreNamed) {
  ScoringRequest request = plain();
  request.extrinsic = "1 2 3 0 0 0 2";
  EXPECT_NE(message_of(request).find("--extrinsic '1 2 3 0 0 0 2': expected"), std::string::npos);
  request = plain();
  request.segments = "a-b";
  EXPECT_NE(message_of(request).find("passed are: none"), std::string::npos);
  request = plain();
  request.waypoint_times = file("p.csv", "x\n");
  EXPECT_NE(message_of(request).find("p.csv:1: expected the header"), std::string::npos);
  request = plain();
  request.times = file("t.txt", "1\nx\n");
  EXPECT_NE(message_of(request).find("t.txt:2: expected one stamp"), std::string::npos);
}

}  // namespace
}  // namespace aims
