// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/lidar/map_covariance.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "core/random.hpp"

namespace aims {
namespace {

const Eigen::Matrix3d kIdentity = Eigen::Matrix3d::Identity();

TEST(MapCovariance, MovesByTheFractionDecidedByTheScan) {
  const std::vector<MappedPlane> planes(3, {Eigen::Vector3d::UnitX(), 4.0 * kIdentity});
  const Eigen::Matrix3d after =
      map_covariance_after_scan(8.0 * kIdentity, kIdentity, 0.25 * kIdentity, planes);
  EXPECT_NEAR(after(0, 0), 0.25 * 8.0 + 0.75 * 4.0, 1e-12);
}

TEST(MapCovariance, StaysAlongAnUnobservableAxis) {
  const std::vector<MappedPlane> planes(5, {Eigen::Vector3d::UnitY(), kIdentity});
  const Eigen::Matrix3d prior = kIdentity;
  const Eigen::Matrix3d posterior = Eigen::Vector3d(1.0, 0.01, 1.0).asDiagonal();
  const Eigen::Matrix3d after =
      map_covariance_after_scan(9.0 * kIdentity, prior, posterior, planes);
  EXPECT_NEAR(after(0, 0), 9.0, 1e-12);
  EXPECT_NEAR(after(1, 1), 0.01 * 9.0 + 0.99 * 1.0, 1e-12);
}

TEST(MapCovariance, EachPlaneCountsAlongItsNormal) {
  std::vector<MappedPlane> planes(40, {Eigen::Vector3d::UnitY(), 100.0 * kIdentity});
  planes.push_back({Eigen::Vector3d::UnitX(), 0.5 * kIdentity});
  const Eigen::Matrix3d after =
      map_covariance_after_scan(Eigen::Matrix3d::Zero(), kIdentity, 1e-9 * kIdentity, planes);
  EXPECT_NEAR(after(0, 0), 0.5, 1e-6);
  EXPECT_NEAR(after(1, 1), 100.0, 1e-3);
}

// A robot that sees only what it mapped one step before: its error is a random walk, and the stated
// variance, of the scan and of the map, is that of the random walk.
TEST(MapCovariance, StatedVarianceIsThatOfARandomWalk) {
  RandomStream random(6, "anchor");
  constexpr double kSigma = 0.02;  // of one scan relative to the map [m]
  constexpr int kSteps = 50;
  constexpr int kWalks = 2000;
  double squares = 0.0;
  for (int walk = 0; walk < kWalks; ++walk) {
    double error = 0.0;
    for (int k = 0; k < kSteps; ++k) error += kSigma * random.normal();
    squares += error * error / kWalks;
  }
  Eigen::Matrix3d map_covariance = Eigen::Matrix3d::Zero();
  const Eigen::Matrix3d relative = kSigma * kSigma * kIdentity;
  Eigen::Matrix3d stated = Eigen::Matrix3d::Zero();
  for (int k = 0; k < kSteps; ++k) {
    const std::vector<MappedPlane> planes(1, {Eigen::Vector3d::UnitX(), stated});
    map_covariance = map_covariance_after_scan(map_covariance, 1e6 * kIdentity, relative, planes);
    stated = relative + map_covariance;
  }
  EXPECT_NEAR(stated(0, 0) / squares, 1.0, 0.1);
}

}  // namespace
}  // namespace aims
