// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/degeneracy/axis_weights.hpp"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

#include "core/random.hpp"
#include "estimator/lidar/plane_model.hpp"

namespace aims {
namespace {

constexpr double kNormalSigma = 0.03;  // [rad]

/// Information of a scan in a corridor along x and what its noisy normals give of it by chance.
struct CorridorScan {
  Matrix6 information = Matrix6::Zero();
  Matrix6 chance = Matrix6::Zero();
};

/// 600 returns of two walls, floor and ceiling, and `facing` of a face across the corridor, with
/// normals that err by kNormalSigma about either axis.
CorridorScan scan_corridor(RandomStream& random, int facing, const Eigen::Matrix3d& R) {
  CorridorScan scan;
  for (int i = 0; i < 600 + facing; ++i) {
    Eigen::Vector3d truth = Eigen::Vector3d::UnitX();
    if (i < 600) truth = (i % 4 < 2 ? 1.0 : -1.0) * Eigen::Vector3d::Unit(1 + i % 2);
    Eigen::Vector3d p = 1.2 * truth;
    if (i < 600) p.x() = 15.0 * (2.0 * random.uniform() - 1.0);
    const Eigen::Matrix3d tangent = Eigen::Matrix3d::Identity() - truth * truth.transpose();
    const Plane plane{(truth + kNormalSigma * tangent * random.normal3()).normalized(), p};
    const Vector6 row = plane_row(plane, R.transpose() * p, R, Eigen::Vector3d::Zero()).jacobian;
    scan.information += row * row.transpose();
    scan.chance += chance_information(kNormalSigma * kNormalSigma * tangent, R.transpose() * p, R);
  }
  return scan;
}

SpuriousConfig exact_chance() {
  SpuriousConfig config;
  config.chance_share = 1.0;
  config.trusting_way = 0.0;
  return config;
}

/// Weight of position along x after 60 scans, 10 cm apart.
double weight_along(const Eigen::Matrix3d& R, int facing) {
  RandomStream random(4, "axes");
  AxisWeigher weigher(exact_chance());
  for (int k = 0; k < 60; ++k) {
    const CorridorScan scan = scan_corridor(random, facing, R);
    weigher.assess(scan.information, scan.chance, R, 0.1);
  }
  const Matrix6 T = weigher.kept(R).T;
  const double kept = T(3, 3);
  EXPECT_GT(T(4, 4), 0.99);
  EXPECT_GT(T(5, 5), 0.99);
  return kept * kept;
}

TEST(AxisWeights, ChanceIsWhatNoisyNormalsGive) {
  RandomStream random(1, "axes");
  const Eigen::Matrix3d R = so3_exp({0.1, -0.2, 0.7}).toRotationMatrix();
  double seen = 0.0;
  double expected = 0.0;
  for (int k = 0; k < 20; ++k) {
    const CorridorScan scan = scan_corridor(random, 0, R);
    seen += scan.information(3, 3);
    expected += scan.chance(3, 3);
  }
  EXPECT_NEAR(seen / expected, 1.0, 0.05);
}

TEST(AxisWeights, PlainWallsTellNothingAlongThem) {
  EXPECT_LT(weight_along(Eigen::Matrix3d::Identity(), 0), 0.01);
  EXPECT_LT(weight_along(so3_exp({0.05, 0.02, 2.0}).toRotationMatrix(), 0), 0.01)
      << "whichever way the robot faces";
}

TEST(AxisWeights, AFewReturnsOfAFaceAreReal) {
  EXPECT_GT(weight_along(Eigen::Matrix3d::Identity(), 30), 0.9);
}

TEST(AxisWeights, NothingIsTrustedBeforeThereIsWay) {
  RandomStream random(2, "axes");
  AxisWeigher weigher(exact_chance());
  const CorridorScan scan = scan_corridor(random, 30, Eigen::Matrix3d::Identity());
  for (int k = 0; k < 50; ++k) {
    weigher.assess(scan.information, scan.chance, Eigen::Matrix3d::Identity(), 0.0);
  }
  EXPECT_EQ(weigher.position().proven().maxCoeff(), 0.0);
  EXPECT_EQ(weigher.kept(Eigen::Matrix3d::Identity()).T.norm(), 0.0);
}

// The start: what little is beyond chance counts before it is significant, and no longer than that.
TEST(AxisWeights, AtTheStartWhatIsBeyondChanceIsTakenOnTrust) {
  RandomStream random(5, "axes");
  SpuriousConfig config = exact_chance();
  config.significant = 1e3;
  config.trusting_way = 4.0;
  AxisWeigher weigher(config);
  const CorridorScan scan = scan_corridor(random, 30, Eigen::Matrix3d::Identity());
  for (double way = 0.1; way < 3.9; way += 0.1) {
    weigher.assess(scan.information, scan.chance, Eigen::Matrix3d::Identity(), 0.1);
  }
  EXPECT_GT(weigher.kept(Eigen::Matrix3d::Identity()).T(3, 3), 0.9);
  EXPECT_LT(weigher.position().proven().minCoeff(), 1e-3) << "taken, not proven";
  weigher.assess(scan.information, scan.chance, Eigen::Matrix3d::Identity(), 0.5);
  EXPECT_LT(weigher.kept(Eigen::Matrix3d::Identity()).T(3, 3), 1e-3);
}

/// Adds the rows of returns next to planes of a map that noise has tilted, seen from a body that is
/// believed `shift` too far along x: along the walls new returns take the place of the old ones,
/// the face alone is seen shifted.
void add_shifted_scan(RandomStream& random, int facing, double shift, CorridorScan& sum,
                      Vector6& vector) {
  const Eigen::Matrix3d I = Eigen::Matrix3d::Identity();
  for (int i = 0; i < 600 + facing; ++i) {
    Eigen::Vector3d truth = Eigen::Vector3d::UnitX();
    if (i < 600) truth = (i % 4 < 2 ? 1.0 : -1.0) * Eigen::Vector3d::Unit(1 + i % 2);
    const Eigen::Matrix3d tangent = I - truth * truth.transpose();
    const Eigen::Vector3d at = 1.2 * truth;
    const Plane plane{(truth + kNormalSigma * tangent * random.normal3()).normalized(), at};
    Eigen::Vector3d p = at + 0.1 * tangent * random.normal3();
    if (i >= 600) p.x() += shift;
    const PlaneRow row = plane_row(plane, p, I, Eigen::Vector3d::Zero());
    sum.information += row.jacobian * row.jacobian.transpose();
    sum.chance += chance_information(kNormalSigma * kNormalSigma * tangent, p, I);
    vector += row.residual * row.jacobian;
  }
}

TEST(AxisWeights, AScanCorrectsTheWholeShiftAlthoughChanceSwellsItsInformation) {
  RandomStream random(6, "axes");
  constexpr double kShift = 0.05;  // [m]
  CorridorScan sum;
  Vector6 vector = Vector6::Zero();
  for (int k = 0; k < 400; ++k) add_shifted_scan(random, 1, kShift, sum, vector);
  AxisWeigher weigher(exact_chance());
  for (int k = 0; k < 100; ++k)
    weigher.assess(sum.information, sum.chance, Eigen::Matrix3d::Identity(), 1.0);
  const KeptOfScan kept = weigher.kept(Eigen::Matrix3d::Identity());
  const Vector6 found = (kept.T * sum.information * kept.T).ldlt().solve(kept.P * vector);
  EXPECT_NEAR(found(3), kShift, 0.1 * kShift);
  EXPECT_LT(sum.information.ldlt().solve(vector)(3), 0.8 * kShift) << "chance holds it back";
}

// Over a thousand scans the information that is kept adds up; along the corridor it must not,
// although the axes that each scan's own noise suggests wobble.
TEST(AxisWeights, NothingLeaksIntoTheWeakAxisOverManyScans) {
  RandomStream random(3, "axes");
  AxisWeigher weigher(exact_chance());
  const Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
  Matrix6 kept = Matrix6::Zero();
  double by_chance = 0.0;
  for (int k = 0; k < 1000; ++k) {
    const CorridorScan scan = scan_corridor(random, 0, R);
    weigher.assess(scan.information, scan.chance, R, 0.1);
    if (k < 50) continue;
    const Matrix6 T = weigher.kept(R).T;
    kept += T * scan.information * T;
    by_chance += scan.chance(3, 3);
  }
  const Eigen::SelfAdjointEigenSolver<Matrix6> solver(kept);
  EXPECT_LT(solver.eigenvalues()(0), 1e-3 * by_chance);
}

// At the start information grows from nothing while the shift is there whole: lengthened without
// bound, the first step threw a robot in a curved tunnel by a metre.
TEST(AxisWeights, AStepIsLengthenedNoFurtherThanSaid) {
  SpuriousConfig config = exact_chance();
  const Eigen::Matrix3d chance = Eigen::Matrix3d::Identity();
  for (const double ratio : {1.01, 1.2, 1.6, 5.0}) {
    const BlockWeights block = weigh_block(ratio * chance, chance, chance, 1.0, config);
    const double information = block.shrink()(0, 0) * block.shrink()(0, 0);
    const double lengthened = block.pull()(0, 0) / information;
    EXPECT_NEAR(lengthened, std::min(ratio / (ratio - 1.0), config.amplification), 1e-6) << ratio;
  }
}

TEST(AxisWeights, AxesStayWhileTheySplitTheInformation) {
  const Eigen::Matrix3d information = Eigen::Vector3d(1.0, 100.0, 100.0).asDiagonal();
  const Eigen::Matrix3d near = so3_exp({0.0, 0.0, 0.01}).toRotationMatrix();
  const Eigen::Matrix3d far = so3_exp({0.0, 0.0, 0.1}).toRotationMatrix();
  EXPECT_EQ(steady_axes(information, near, 0.02), near);
  const Eigen::Matrix3d found = steady_axes(information, far, 0.02);
  EXPECT_NEAR(std::abs(found(0, 0)), 1.0, 1e-9) << "the weakest axis is x again";
}

TEST(AxisWeights, RealityRisesThroughAHalfAtTheSignificantRatio) {
  const SpuriousConfig config;
  EXPECT_DOUBLE_EQ(reality(config.significant, config.significant, config), 0.5);
  EXPECT_LT(reality(1.0, config.significant, config), 1e-6);
  EXPECT_GT(reality(3.0, config.significant, config), 0.999);
  EXPECT_EQ(reality(0.0, config.significant, config), 0.0);
}

}  // namespace
}  // namespace aims
