// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/degeneracy/axis_weights.hpp"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

#include "core/random.hpp"
#include "estimator/lidar/plane_model.hpp"

namespace aims {
namespace {

constexpr double kNormalSigma = 0.03;  // [rad]

/// Information of a scan in a corridor along x, and its expected noise-induced part.
struct CorridorScan {
  Matrix6 information = Matrix6::Zero();
  Matrix6 noise = Matrix6::Zero();
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
    scan.noise += noise_information(kNormalSigma * kNormalSigma * tangent, R.transpose() * p, R);
  }
  return scan;
}

NoiseInformationConfig exact_noise() {
  NoiseInformationConfig config;
  config.scale = 1.0;
  config.bootstrap_distance = 0.0;
  return config;
}

/// Real fraction of position along x after 60 scans, 10 cm apart.
double fraction_along(const Eigen::Matrix3d& R, int facing) {
  RandomStream random(4, "axes");
  AxisWeigher weigher(exact_noise());
  for (int k = 0; k < 60; ++k) {
    const CorridorScan scan = scan_corridor(random, facing, R);
    weigher.assess(scan.information, scan.noise, R, 0.1);
  }
  const Matrix6 F = weigher.real_fraction(R);
  EXPECT_GT(F(4, 4), 0.99);
  EXPECT_GT(F(5, 5), 0.99);
  return F(3, 3);
}

TEST(AxisWeights, NoiseInformationIsThatOfNoisyNormals) {
  RandomStream random(1, "axes");
  const Eigen::Matrix3d R = so3_exp({0.1, -0.2, 0.7}).toRotationMatrix();
  double measured = 0.0;
  double expected = 0.0;
  for (int k = 0; k < 20; ++k) {
    const CorridorScan scan = scan_corridor(random, 0, R);
    measured += scan.information(3, 3);
    expected += scan.noise(3, 3);
  }
  EXPECT_NEAR(measured / expected, 1.0, 0.05);
}

TEST(AxisWeights, PlainWallsGiveNoInformationAlongThem) {
  EXPECT_LT(fraction_along(Eigen::Matrix3d::Identity(), 0), 0.01);
  EXPECT_LT(fraction_along(so3_exp({0.05, 0.02, 2.0}).toRotationMatrix(), 0), 0.01)
      << "whichever way the robot faces";
}

TEST(AxisWeights, AFewReturnsOfAFaceAreSignificant) {
  EXPECT_GT(fraction_along(Eigen::Matrix3d::Identity(), 30), 0.9);
}

TEST(AxisWeights, NothingIsSignificantBeforeTheRobotMoves) {
  RandomStream random(2, "axes");
  AxisWeigher weigher(exact_noise());
  const CorridorScan scan = scan_corridor(random, 30, Eigen::Matrix3d::Identity());
  for (int k = 0; k < 50; ++k) {
    weigher.assess(scan.information, scan.noise, Eigen::Matrix3d::Identity(), 0.0);
  }
  EXPECT_EQ(weigher.position().significant().maxCoeff(), 0.0);
  EXPECT_EQ(weigher.real_fraction(Eigen::Matrix3d::Identity()).norm(), 0.0);
}

// At the start, information beyond noise is used before it is significant.
TEST(AxisWeights, InformationBeyondNoiseIsAcceptedWithinTheBootstrapDistance) {
  RandomStream random(5, "axes");
  NoiseInformationConfig config = exact_noise();
  config.significance_ratio = 1e3;
  config.bootstrap_distance = 4.0;
  AxisWeigher weigher(config);
  const CorridorScan scan = scan_corridor(random, 30, Eigen::Matrix3d::Identity());
  for (double distance = 0.1; distance < 3.9; distance += 0.1) {
    weigher.assess(scan.information, scan.noise, Eigen::Matrix3d::Identity(), 0.1);
  }
  EXPECT_GT(weigher.real_fraction(Eigen::Matrix3d::Identity())(3, 3), 0.9);
  EXPECT_EQ(weigher.position().gain_factor()(0, 0), 1.0);
  EXPECT_LT(weigher.position().significant().minCoeff(), 1e-3) << "accepted, not significant";
  weigher.assess(scan.information, scan.noise, Eigen::Matrix3d::Identity(), 0.5);
  EXPECT_LT(weigher.position().gain_factor()(0, 0), 1e-3);
}

/// Adds the rows of returns near planes of a noisy map, for a pose estimate with the error `shift`
/// along x: returns on the walls slide along them, only those on the face are displaced.
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
    sum.noise += noise_information(kNormalSigma * kNormalSigma * tangent, p, I);
    vector += row.residual * row.jacobian;
  }
}

TEST(AxisWeights, AScanCorrectsTheFullShiftDespiteNoiseInformation) {
  RandomStream random(6, "axes");
  constexpr double kShift = 0.05;  // [m]
  CorridorScan sum;
  Vector6 vector = Vector6::Zero();
  for (int k = 0; k < 400; ++k) add_shifted_scan(random, 1, kShift, sum, vector);
  AxisWeigher weigher(exact_noise());
  for (int k = 0; k < 100; ++k)
    weigher.assess(sum.information, sum.noise, Eigen::Matrix3d::Identity(), 1.0);
  const Matrix6 F = weigher.real_fraction(Eigen::Matrix3d::Identity());
  const Vector6 found = (F * sum.information * F.transpose()).ldlt().solve(F * vector);
  EXPECT_NEAR(found(3), kShift, 0.1 * kShift);
  EXPECT_LT(sum.information.ldlt().solve(vector)(3), 0.8 * kShift)
      << "noise information shortens the step";
}

// The remaining information adds up over a thousand scans; along the corridor it must not, although
// the principal axes of single scans vary with their noise.
TEST(AxisWeights, NoInformationLeaksIntoTheWeakAxisOverManyScans) {
  RandomStream random(3, "axes");
  AxisWeigher weigher(exact_noise());
  const Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
  Matrix6 kept = Matrix6::Zero();
  double from_noise = 0.0;
  for (int k = 0; k < 1000; ++k) {
    const CorridorScan scan = scan_corridor(random, 0, R);
    weigher.assess(scan.information, scan.noise, R, 0.1);
    if (k < 50) continue;
    const Matrix6 F = weigher.real_fraction(R);
    kept += F * scan.information * F.transpose();
    from_noise += scan.noise(3, 3);
  }
  const Eigen::SelfAdjointEigenSolver<Matrix6> solver(kept);
  EXPECT_LT(solver.eigenvalues()(0), 1e-3 * from_noise);
}

/// Errors of an estimated shift over many draws, in the deviations that the filter states.
struct ShiftErrors {
  double bias = 0.0;      ///< mean
  double variance = 0.0;  ///< mean square
};

/// One axis: the error state s with the prior N(0, 1), and 40 returns whose rows hold h_i = 1 at
/// the fraction `real` of the sum of squares and a noise e_i of the normals at the rest. A return
/// responds to s through h_i alone, r_i = h_i s + v_i, while the filter sees h_i + e_i.
ShiftErrors shift_errors_on_one_axis(double real, RandomStream& random) {
  constexpr int kDraws = 20000;
  constexpr int kReturns = 40;
  constexpr double kResidual = 3.0;  // deviation of v_i
  const double h = std::sqrt(real);
  const double e = std::sqrt(1.0 - real);
  NoiseInformationConfig config = exact_noise();
  ShiftErrors errors;
  for (int draw = 0; draw < kDraws; ++draw) {
    const double shift = random.normal();
    double A = 0.0;
    double b = 0.0;
    for (int i = 0; i < kReturns; ++i) {
      const double row = h + e * random.normal();
      A += row * row / (kResidual * kResidual);
      b += row * (h * shift + kResidual * random.normal()) / (kResidual * kResidual);
    }
    const Eigen::Matrix3d I = Eigen::Matrix3d::Identity();
    const double expected = kReturns / (kResidual * kResidual);
    const double f =
        weigh_axes(expected * I, expected * e * e * I, I, 1.0, config).real_fraction()(0, 0);
    const double information = 1.0 + f * A * f;
    const double error = f * b / information - shift;
    errors.bias += error * shift / kDraws;
    errors.variance += error * error * information / kDraws;
  }
  return errors;
}

// With the matrix reduced by f but the vector whole, the stated variance was 2 to 2.5 times too
// small at f = 0.4.
TEST(AxisWeights, TheStatedVarianceOfAShiftIsItsRealOneOnOneAxis) {
  RandomStream random(11, "one_axis");
  for (const double real : {0.2, 0.4, 0.6, 0.9}) {
    EXPECT_NEAR(shift_errors_on_one_axis(real, random).variance, 1.0, 0.08)
        << "fraction " << real << ", seed 11";
  }
}

TEST(AxisWeights, AxesPersistWhileTheyDiagonalizeTheInformation) {
  const Eigen::Matrix3d information = Eigen::Vector3d(1.0, 100.0, 100.0).asDiagonal();
  const Eigen::Matrix3d near = so3_exp({0.0, 0.0, 0.01}).toRotationMatrix();
  const Eigen::Matrix3d far = so3_exp({0.0, 0.0, 0.1}).toRotationMatrix();
  EXPECT_EQ(persistent_axes(information, near, 0.02), near);
  const Eigen::Matrix3d found = persistent_axes(information, far, 0.02);
  EXPECT_NEAR(std::abs(found(0, 0)), 1.0, 1e-9) << "the weakest axis is x again";
}

TEST(AxisWeights, AcceptanceProbabilityIsOneHalfAtTheThreshold) {
  const NoiseInformationConfig config;
  EXPECT_DOUBLE_EQ(
      acceptance_probability(config.significance_ratio, config.significance_ratio, config), 0.5);
  EXPECT_LT(acceptance_probability(1.0, config.significance_ratio, config), 1e-6);
  EXPECT_GT(acceptance_probability(3.0, config.significance_ratio, config), 0.999);
  EXPECT_EQ(acceptance_probability(0.0, config.significance_ratio, config), 0.0);
}

}  // namespace
}  // namespace aims
