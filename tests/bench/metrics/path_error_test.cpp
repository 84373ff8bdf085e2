// SPDX-License-Identifier: BSD-3-Clause
#include "bench/metrics/path_error.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>

#include "core/random.hpp"

namespace aims {
namespace {

/// A walk along a wavy line at about 1 m/s and 10 Hz, and an estimate with noise and drift.
std::vector<PosePair> walk(int poses) {
  RandomStream random = rng(5, "test.path_error");
  std::vector<PosePair> pairs;
  double heading = 0.0;
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  for (int i = 0; i < poses; ++i) {
    heading += 0.05 * random.normal();
    position += 0.103 * Eigen::Vector3d(std::cos(heading), std::sin(heading), 0.01);
    PosePair pair;
    pair.stamp = i * 100 * kMillisecond;
    pair.truth = {yaw_rotation(heading), position};
    pair.estimate = {yaw_rotation(1.0 + heading * 1.02) * so3_exp(0.001 * random.normal3()),
                     yaw_rotation(1.0) * (0.97 * position) + 0.01 * random.normal3()};
    pairs.push_back(pair);
  }
  return pairs;
}

Eigen::Isometry3d matrix(const Pose& pose) {
  Eigen::Isometry3d m = Eigen::Isometry3d::Identity();
  m.linear() = pose.rotation.toRotationMatrix();
  m.translation() = pose.translation;
  return m;
}

/// The development kit's loops, with matrices and every tenth pose.
struct Oracle {
  double translation = 0.0;  ///< sum over pieces
  double rotation = 0.0;     ///< sum over pieces [rad/m]
  int pieces = 0;

  void add(const std::vector<PosePair>& pairs, double length) {
    for (std::size_t first = 0; first < pairs.size(); first += 10) {
      double walked = 0.0;
      std::size_t last = first;
      while (walked <= length && last + 1 < pairs.size()) {
        walked += (pairs[last + 1].truth.translation - pairs[last].truth.translation).norm();
        ++last;
      }
      if (walked <= length) continue;
      const Eigen::Isometry3d truly =
          matrix(pairs[first].truth).inverse() * matrix(pairs[last].truth);
      const Eigen::Isometry3d estimated =
          matrix(pairs[first].estimate).inverse() * matrix(pairs[last].estimate);
      const Eigen::Isometry3d error = estimated.inverse() * truly;
      const double cosine = 0.5 * (error.linear().trace() - 1.0);
      translation += error.translation().norm() / length;
      rotation += std::acos(std::clamp(cosine, -1.0, 1.0)) / length;
      ++pieces;
    }
  }
};

TEST(PathErrors, AgreeWithTheLoopsOfKitti) {
  const std::vector<PosePair> pairs = walk(1300);
  const PathErrors errors = path_errors(pairs);
  ASSERT_EQ(errors.lengths.size(), std::size(kPathErrorLengths));
  Oracle all;
  for (const PathError& each : errors.lengths) {
    Oracle own;
    own.add(pairs, each.length_m);
    all.add(pairs, each.length_m);
    ASSERT_GT(own.pieces, 20);
    EXPECT_EQ(each.pieces, own.pieces);
    EXPECT_NEAR(*each.translation_percent, 100.0 * own.translation / own.pieces, 1e-9);
    EXPECT_NEAR(*each.rotation_deg_per_m, 180.0 / std::numbers::pi * own.rotation / own.pieces,
                1e-6);
  }
  EXPECT_EQ(errors.all.pieces, all.pieces);
  EXPECT_NEAR(*errors.all.translation_percent, 100.0 * all.translation / all.pieces, 1e-9);
}

TEST(PathErrors, OfAScaleErrorAreThatErrorAtEveryLength) {
  std::vector<PosePair> pairs;
  for (int i = 0; i < 2000; ++i) {
    const Eigen::Vector3d position(0.1003 * i, 0.0, 0.3);
    pairs.push_back({i * 100 * kMillisecond,
                     {yaw_rotation(0.4), yaw_rotation(0.4) * (0.98 * position)},
                     {yaw_rotation(0.0), position}});
  }
  for (const PathError& each : path_errors(pairs).lengths) {
    // A piece ends up to a step of 0.1 m beyond its length.
    EXPECT_GE(*each.translation_percent, 2.0);
    EXPECT_LE(*each.translation_percent, 2.0 * (1.0 + 0.1003 / each.length_m));
    EXPECT_NEAR(*each.rotation_deg_per_m, 0.0, 1e-6);
  }
}

TEST(PathErrors, OfAShortPathHaveNoValue) {
  const PathErrors errors = path_errors(walk(150));
  EXPECT_TRUE(errors.lengths[1].translation_percent) << "15 m";
  EXPECT_FALSE(errors.lengths[2].translation_percent) << "20 m";
  EXPECT_EQ(errors.lengths[2].pieces, 0);
  EXPECT_FALSE(path_errors({}).all.translation_percent);
}

}  // namespace
}  // namespace aims
