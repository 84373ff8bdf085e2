// SPDX-License-Identifier: BSD-3-Clause
#include "bench/scoring/score_hints.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

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

}  // namespace
}  // namespace aims
