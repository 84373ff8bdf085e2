// SPDX-License-Identifier: BSD-3-Clause
#include "bench/scoring/score_hints.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

namespace aims {
namespace {

/// What is said of a truth whose poses are those of the estimate, changed.
std::string hint_of(const std::function<Pose(const Pose&)>& changed) {
  Trajectory estimate, truth;
  Eigen::Vector3d place = Eigen::Vector3d::Zero();
  for (int i = 0; i < 300; ++i) {
    const double yaw = 2.0 * std::sin(0.03 * i);
    place += yaw_rotation(yaw) * Eigen::Vector3d(0.1, 0.0, 0.0);
    const Pose pose{yaw_rotation(yaw), place + Eigen::Vector3d(0.0, 0.0, 0.5 * std::sin(0.05 * i))};
    estimate.push_back({i * kSecond / 10, pose});
    truth.push_back({i * kSecond / 10, changed(pose)});
  }
  return world_hint(estimate, truth, {}).value_or("");
}

TEST(WorldHint, OtherConventionsOfATruthAreNamed) {
  EXPECT_EQ(hint_of([](const Pose& pose) { return pose; }), "");
  const auto ned = [](const Pose& pose) {
    const Eigen::Vector3d& p = pose.translation;
    return Pose{pose.rotation, {p.y(), p.x(), -p.z()}};
  };
  const auto mirrored = [](const Pose& pose) {
    const Eigen::Vector3d& p = pose.translation;
    return Pose{pose.rotation, {p.x(), -p.y(), p.z()}};
  };
  EXPECT_NE(hint_of(ned).find("the worlds have other axes"), std::string::npos) << hint_of(ned);
  EXPECT_NE(hint_of(mirrored).find("left-handed"), std::string::npos) << hint_of(mirrored);
  const auto inverse = [](const Pose& pose) { return pose.inverse(); };
  EXPECT_NE(hint_of(inverse).find("inverse of the truth's poses"), std::string::npos)
      << hint_of(inverse);
}

TEST(WorldHint, AnEstimateThatDriftsIsOfNoOtherConvention) {
  const auto drifting = [](const Pose& pose) {
    const Eigen::Vector3d& p = pose.translation;
    return Pose{pose.rotation, {1.4 * p.x() + 0.3 * p.y(), p.y() + std::sin(p.x()), p.z()}};
  };
  EXPECT_EQ(hint_of(drifting), "");
}

/// A line along x at 1 m/s, 10 Hz, from `start` on; from `still` on it stays.
Trajectory line(Time start, int poses, int still = 1 << 20) {
  Trajectory trajectory;
  for (int i = 0; i < poses; ++i) {
    trajectory.push_back({start + i * kSecond / 10,
                          {Eigen::Quaterniond::Identity(), {0.1 * std::min(i, still), 0.0, 0.0}}});
  }
  return trajectory;
}

/// Its stamps as numbers of frames, from `first` on.
Trajectory with_frames(Trajectory trajectory, int first) {
  for (StampedPose& each : trajectory) each.stamp = kSecond * first++;
  return trajectory;
}

TEST(FrameIndexHint, StampsThatAreNumbersOfFramesAreNamed) {
  const Trajectory truth = line(1'700'000'000 * kSecond, 300);
  const std::string hint = frame_index_hint(with_frames(truth, 0), truth).value_or("");
  EXPECT_NE(hint.find("its stamps are the whole numbers from 0 to 299, likely numbers of frames"),
            std::string::npos)
      << hint;
  EXPECT_NE(hint.find("--times FILE"), std::string::npos) << hint;
  EXPECT_TRUE(frame_index_hint(with_frames(truth, 1), truth));
  EXPECT_TRUE(frame_index_hint(with_frames(truth, 0), line(0, 300))) << "they overlap";
  EXPECT_NE(frame_index_hint(truth, with_frames(truth, 0)).value_or("").find("the truth's stamps"),
            std::string::npos);
}

TEST(FrameIndexHint, SecondsAreNoFrames) {
  const Trajectory truth = line(1'700'000'000 * kSecond, 300);
  EXPECT_FALSE(frame_index_hint(line(0, 300), truth)) << "10 Hz";
  EXPECT_FALSE(frame_index_hint(with_frames(line(0, 30), 0), line(0, 300))) << "1 Hz";
  EXPECT_FALSE(frame_index_hint(with_frames(line(0, 31), 0), truth)) << "1 Hz, another clock";
  EXPECT_FALSE(frame_index_hint(with_frames(truth, 0), with_frames(truth, 0))) << "both";
}

TEST(FrozenTruthHint, ATruthThatRepeatsItsPoseWhileTheRobotWalksIsNamed) {
  const Trajectory walk = line(0, 300);
  const auto hint_of = [](const Trajectory& truth, std::vector<const Trajectory*> estimates) {
    return frozen_truth_hint(truth, estimates).value_or("");
  };
  const std::string hint = hint_of(line(0, 300, 200), {&walk});
  EXPECT_NE(hint.find("from 20.0 s after its start to its end, for 9.9 s"), std::string::npos)
      << hint;
  const Trajectory standing = line(0, 300, 200);
  EXPECT_EQ(hint_of(standing, {&standing}), "") << "the robot stands";
  EXPECT_EQ(hint_of(standing, {&walk, &standing}), "") << "one estimate agrees";
  EXPECT_EQ(hint_of(walk, {&walk}), "");
  EXPECT_EQ(hint_of(line(0, 300, 290), {&walk}), "") << "a second";
}

TEST(BodyFrameHint, AnAxisHasNoNegativeZeros) {
  Trajectory truth, estimate;
  for (int i = 0; i < 100; ++i) {
    const double t = 0.1 * i;
    const Pose pose{yaw_rotation(0.3 * std::sin(t)), {t, 2.0 * std::sin(0.5 * t), 0.0}};
    truth.push_back({i * kSecond / 10, pose});
    const Eigen::Vector3d axis = Eigen::Vector3d(0.8, 0.6, -1e-3).normalized();
    estimate.push_back({i * kSecond / 10, {pose.rotation * so3_exp(axis), pose.translation}});
  }
  const std::string hint = body_frame_hint(estimate, truth, {}, {}).value_or("");
  EXPECT_NE(hint.find("about [0.80, 0.60, 0.00]"), std::string::npos) << hint;
}

}  // namespace
}  // namespace aims
