// SPDX-License-Identifier: BSD-3-Clause
#include "bench/metrics/localizability.hpp"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <cmath>

#include "bench/metrics/localizability_scores.hpp"
#include "core/random.hpp"

namespace aims {
namespace {

using Eigen::Vector3d;
using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Vector6 = Eigen::Matrix<double, 6, 1>;

Matrix6 random_information(std::uint64_t seed, int rows) {
  RandomStream random(seed, "test.information");
  Matrix6 sum = Matrix6::Zero();
  for (int i = 0; i < rows; ++i) {
    Vector6 h;
    for (double& each : h) each = random.normal();
    sum += h * h.transpose();
  }
  return sum;
}

/// Returns of a corridor along x: walls, floor and ceiling; `ends` returns of a wall ahead.
ScanInformation corridor_scan(int ends) {
  ScanInformation scan;
  scan.range_sigma = 0.02;
  const auto add = [&scan](const Vector3d& p, const Vector3d& n) {
    Vector6 h;
    h << p.cross(n), n;
    scan.information += h * h.transpose() / (0.02 * 0.02);
    ++scan.returns;
  };
  for (int i = -10; i <= 10; ++i) {
    for (const double side : {-1.1, 1.1}) {
      add({0.5 * i, side, 0.1 * (i % 4)}, Vector3d::UnitY());
      add({0.5 * i, 0.1 * (i % 3), side}, Vector3d::UnitZ());
    }
  }
  for (int i = 0; i < ends; ++i) add({20.0, 0.0, 0.0}, -Vector3d::UnitX());
  return scan;
}

TEST(Localizability, BlocksAreTheInversesOfTheBlocksOfTheCovariance) {
  const Matrix6 information = random_information(3, 12);
  const Matrix6 covariance = information.inverse();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> translation(
      covariance.bottomRightCorner<3, 3>().inverse());
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> rotation(
      covariance.topLeftCorner<3, 3>().inverse());
  const BlockInformation found = translation_information(information);
  EXPECT_TRUE(found.eigenvalues.isApprox(translation.eigenvalues(), 1e-9));
  EXPECT_NEAR(std::abs(found.weak_axis().dot(translation.eigenvectors().col(0))), 1.0, 1e-9);
  EXPECT_TRUE(rotation_information(information).eigenvalues.isApprox(rotation.eigenvalues(), 1e-9));
}

TEST(Localizability, CountsEquivalentFacingReturns) {
  const Localizability scan = localizability_of(corridor_scan(25), Pose{});
  EXPECT_NEAR(scan.equivalent_returns, 25.0, 1e-6);
  EXPECT_NEAR(scan.sigma, 0.02 / 5.0, 1e-9);
  EXPECT_NEAR(std::abs(scan.weak_axis_in_body.x()), 1.0, 1e-9);
  EXPECT_FALSE(is_degenerate(scan, {"", 25.0 - 1e-3}));
  EXPECT_TRUE(is_degenerate(scan, {"", 25.0 + 1e-3}));
}

TEST(Localizability, WithoutEndWallsTheBoundIsInfiniteAndNothingIsNan) {
  for (const ScanInformation& scan : {corridor_scan(0), ScanInformation{}}) {
    const Localizability result = localizability_of(scan, Pose{});
    EXPECT_EQ(result.lambda_min, 0.0);
    EXPECT_EQ(result.equivalent_returns, 0.0);
    EXPECT_TRUE(std::isinf(result.sigma));
    EXPECT_TRUE(result.weak_axis_in_body.allFinite());
    EXPECT_NEAR(result.weak_axis_in_body.norm(), 1.0, 1e-12);
    for (const DegeneracyLevel& level : kDegeneracyLevels) {
      EXPECT_TRUE(is_degenerate(result, level)) << level.name;
    }
  }
}

TEST(Localizability, TurnsTheWeakAxisIntoTheWorldByTheTruePose) {
  const Pose pose{yaw_rotation(0.7), {1.0, 2.0, 3.0}};
  const Localizability scan = localizability_of(corridor_scan(5), pose);
  const Vector3d expected(std::cos(0.7), std::sin(0.7), 0.0);
  EXPECT_NEAR(std::abs(scan.weak_axis_in_world.dot(expected)), 1.0, 1e-9);
}

TEST(Localizability, LevelsFollowFromOneAnother) {
  for (std::size_t i = 1; i < kDegeneracyLevels.size(); ++i) {
    EXPECT_LT(kDegeneracyLevels[i - 1].equivalent_returns, kDegeneracyLevels[i].equivalent_returns);
  }
}

TEST(NearestStamp, KeepsToTheToleranceAndPrefersTheEarlier) {
  const std::vector<Time> stamps = {100, 200, 300};
  EXPECT_EQ(nearest_stamp(stamps, 150, 50), 0U);
  EXPECT_EQ(nearest_stamp(stamps, 151, 50), 1U);
  EXPECT_EQ(nearest_stamp(stamps, 340, 50), 2U);
  EXPECT_EQ(nearest_stamp(stamps, 351, 50), std::nullopt);
  EXPECT_EQ(nearest_stamp(stamps, 49, 50), std::nullopt);
  EXPECT_EQ(nearest_stamp({}, 0, 50), std::nullopt);
}

/// Estimates that are off along x by a known signed amount.
TEST(WeakAxisErrors, ProjectErrorBoundAndStatedVarianceOnTheWeakAxis) {
  std::vector<PosePair> pairs;
  std::vector<StatedCovariance> stated;
  std::vector<Localizability> scans;
  std::vector<PosteriorBound> bounds;
  const Pose truth{yaw_rotation(0.7), {5.0, 1.0, 0.3}};
  for (int i = 0; i < 4; ++i) {
    const Time stamp = i * 100 * kMillisecond;
    scans.push_back(localizability_of(corridor_scan(i < 2 ? 5 : 20), truth));
    scans.back().stamp = stamp;
    PosteriorBound bound;
    bound.position = Vector3d(0.04, 0.01, 0.01).asDiagonal();
    bound.position = truth.R() * bound.position * truth.R().transpose();
    bounds.push_back(bound);
    Pose estimate = truth;
    estimate.translation += truth.rotation * Vector3d(i < 2 ? 0.4 : 0.2, 3.0, 5.0);
    pairs.push_back({stamp + 20 * kMillisecond, estimate, truth});
    stated.push_back({stamp + 20 * kMillisecond, Vector3d(0.01, 9.0, 9.0).asDiagonal()});
  }
  const auto errors = weak_axis_errors(pairs, stated, scans, bounds, 50 * kMillisecond);
  ASSERT_EQ(errors.size(), 4U);
  const auto scores = weak_axis_scores(errors);
  ASSERT_EQ(scores[0].level, "all");
  EXPECT_EQ(scores[0].scans, 4);
  EXPECT_NEAR(*scores[0].error_rms_m, std::sqrt((2 * 0.16 + 2 * 0.04) / 4), 1e-9);
  EXPECT_EQ(scores[1].scans, 2) << scores[1].level;
  EXPECT_NEAR(*scores[1].error_rms_m, 0.4, 1e-9);
  EXPECT_NEAR(*scores[1].bound_rms_m, 0.2, 1e-9);
  EXPECT_NEAR(*scores[1].efficiency, 0.5, 1e-9);
  EXPECT_NEAR(*scores[1].nees, 16.0, 1e-6);
  const auto none = weak_axis_errors(pairs, stated, scans, bounds, 10 * kMillisecond);
  EXPECT_TRUE(none.empty());
  EXPECT_FALSE(weak_axis_scores(none)[0].error_rms_m);
}

}  // namespace
}  // namespace aims
