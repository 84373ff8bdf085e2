// SPDX-License-Identifier: BSD-3-Clause
// The search of a scan along its drift.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "tests/estimator/aims/corridor_walk.hpp"

namespace aims {
namespace {

using E = ErrorState;
using test::CorridorWalk;
using test::kHalfWidth;
using test::kNoise;
using test::kRange;

/// A point of a face across the corridor at `x`.
Eigen::Vector3d on_face(double x, RandomStream& random) {
  return Eigen::Vector3d(x, kHalfWidth * (2.0 * random.uniform() - 1.0),
                         kHalfWidth * (2.0 * random.uniform() - 1.0)) +
         kNoise * random.normal3();
}

/// What a scan made of its prediction.
struct FaceScan {
  double error = 0.0;  ///< of the position along the corridor afterwards [m]
  bool relocated = false;
};

/// What a scan of which 20 of 800 returns lie on a face `seen` ahead of where the robot was makes
/// of a prediction that is `drift` too far along the corridor, with a deviation of `sigma`, while
/// the map has a face `mapped` ahead [m]. Of five scans, over which the robot walks on by 0.2 m
/// each, the first that is matched elsewhere, or the last one.
FaceScan fuse_with_faces(CorridorWalk& walk, double mapped, double seen, double drift, double sigma,
                         ScanPart part) {
  RandomStream& random = walk.random;
  const double start = walk.truth.x();
  for (int i = 0; i < 60; ++i) {  // enough for both halves
    std::vector<Eigen::Vector3f> face;
    for (int k = 0; k < 100; ++k) face.push_back(on_face(start + mapped, random).cast<float>());
    walk.map.insert(face, Eigen::Vector3f::Zero());
  }
  FaceScan result;
  for (int scans = 0; scans < 5 && !result.relocated; ++scans) {
    walk.truth.x() += 0.2;
    std::vector<Eigen::Vector3f> scan;
    const auto add = [&](const Eigen::Vector3d& p) {
      scan.push_back((p - walk.truth).cast<float>());
    };
    for (int i = 0; i < 780; ++i) {
      add(walk.corridor.point(start + 1.0 - kRange, start + std::min(mapped, seen)));
    }
    for (int i = 0; i < 20; ++i) add(on_face(start + seen, random));
    Belief predicted;
    predicted.state.position = walk.truth + drift * Eigen::Vector3d::UnitX();
    predicted.covariance = 1e-4 * ErrorMatrix::Identity();
    predicted.covariance(E::kPosition.offset, E::kPosition.offset) = sigma * sigma;
    walk.diagnostics = ScanDiagnostics();
    const Belief updated =
        walk.update.update(predicted, scan, walk.map, CalibrationModel(), part, walk.diagnostics);
    result = {updated.state.position.x() - walk.truth.x(), walk.diagnostics.relocated};
  }
  return result;
}

// A robot that comes back with a drift larger than a residual may be has no match with the end
// wall.
TEST(LidarUpdateSearch, FindsAnEndWallAlongItsDrift) {
  for (const ScanPart part : {ScanPart::kAll, ScanPart::kReal}) {
    for (const double drift : {-0.6, -0.35, 0.35, 1.0}) {
      CorridorWalk walk(false);
      const FaceScan scan = fuse_with_faces(walk, 5.0, 5.0, drift, std::abs(drift), part);
      EXPECT_TRUE(scan.relocated) << drift << " m";
      EXPECT_NEAR(scan.error, 0.0, 0.1 * std::abs(drift)) << drift << " m";
    }
  }
}

TEST(LidarUpdateSearch, SearchesOnlyWhereItsPredictionMayBe) {
  CorridorWalk walk(false);
  EXPECT_FALSE(fuse_with_faces(walk, 5.0, 5.0, 0.6, 0.15, ScanPart::kReal).relocated);
}

// The back of a pillar is met on the way back only. At the offset that puts it onto the front,
// which the map has, fewer of the other returns match.
TEST(LidarUpdateSearch, StaysWhereMoreOfTheScanMatches) {
  CorridorWalk walk(true);
  const FaceScan scan = fuse_with_faces(walk, 4.3, 5.0, 0.0, 0.5, ScanPart::kReal);
  EXPECT_FALSE(scan.relocated);
  EXPECT_NEAR(scan.error, 0.0, 0.02);
}

}  // namespace
}  // namespace aims
