// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/degeneracy/cross_validation.hpp"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <cmath>
#include <optional>

#include "core/random.hpp"
#include "estimator/filter/pose_information.hpp"
#include "estimator/lidar/plane_model.hpp"

namespace aims {
namespace {

constexpr double kNormalSigma = 0.05;  // of each half's normals [rad]
constexpr double kWeight = 400.0;      // of a return [1/m^2]
constexpr double kStep = 0.1;          // between scans [m]

/// 600 returns of the walls, floor and ceiling of a corridor along x and `facing` of faces across
/// it; the normals of each half of the map err on their own. The prediction is `shift` [m] behind:
/// returns on the walls are matched with what is mapped there, only the faces show it. The returns
/// have noise of `range_sigma` [m], common to both halves.
HalvesInformation scan_corridor(RandomStream& random, int facing, double shift = 0.0,
                                double range_sigma = 0.0) {
  HalvesInformation sum;
  for (int i = 0; i < 600 + facing; ++i) {
    Eigen::Vector3d normal = Eigen::Vector3d::UnitX();
    if (i < 600) normal = (i % 4 < 2 ? 1.0 : -1.0) * Eigen::Vector3d::Unit(1 + i % 2);
    Eigen::Vector3d p = 1.2 * normal;
    for (int other : {0, 1, 2}) {
      if (normal(other) == 0.0) p(other) = random.uniform(-1.0, 1.0) * (other == 0 ? 15.0 : 1.2);
    }
    const double noise = range_sigma > 0.0 ? range_sigma * random.normal() : 0.0;
    const auto row = [&] {
      const Eigen::Matrix3d tangent = Eigen::Matrix3d::Identity() - normal * normal.transpose();
      const Eigen::Vector3d predicted = p - shift * Eigen::Vector3d::UnitX();
      const Eigen::Vector3d mapped = i < 600 ? predicted : p;
      const Plane plane{(normal + kNormalSigma * tangent * random.normal3()).normalized(),
                        mapped + 0.15 * tangent * random.normal3(), true};
      return plane_row(plane, predicted + noise * normal, Eigen::Matrix3d::Identity(),
                       Eigen::Vector3d::Zero());
    };
    const PlaneRow a = row();
    const PlaneRow b = row();
    sum.within +=
        0.5 * kWeight * (a.jacobian * a.jacobian.transpose() + b.jacobian * b.jacobian.transpose());
    sum.across +=
        0.5 * kWeight * (a.jacobian * b.jacobian.transpose() + b.jacobian * a.jacobian.transpose());
    sum.within_vector += 0.5 * kWeight * (a.jacobian * a.residual + b.jacobian * b.residual);
    sum.across_vector += 0.5 * kWeight * (a.jacobian * b.residual + b.jacobian * a.residual);
  }
  return sum;
}

/// After `scans` scans, `step` [m] apart.
CrossValidatedInformation after(RandomStream& random, int facing, int scans, double step) {
  CrossValidatedInformation fraction;
  for (int k = 0; k < scans; ++k) {
    fraction.add(scan_corridor(random, facing), Eigen::Vector3d(step * k, 0.0, 0.0));
  }
  return fraction;
}

TEST(CrossValidatedInformation, ACorridorWithoutFeaturesLeavesItsAxisFree) {
  RandomStream random(1, "cross_validation");
  const CrossValidatedInformation fraction = after(random, 0, 60, kStep);
  EXPECT_TRUE(fraction.leaves_direction_free());
  const Eigen::Matrix3d across =
      Eigen::Matrix3d::Identity() - Eigen::Vector3d::UnitX() * Eigen::Vector3d::UnitX().transpose();
  EXPECT_LT((fraction.constrained() - across).cwiseAbs().maxCoeff(), 0.05);
}

TEST(CrossValidatedInformation, FacesAcrossTheCorridorConstrainItsAxis) {
  RandomStream random(2, "cross_validation");
  const CrossValidatedInformation fraction = after(random, 60, 60, kStep);
  EXPECT_FALSE(fraction.leaves_direction_free());
  EXPECT_LT((fraction.constrained() - Eigen::Matrix3d::Identity()).norm(), 1e-12);
}

// An average that decays by e over 3 m would remember 300 faces for 27 m.
TEST(CrossValidatedInformation, AfterABendThePreviousCorridorIsForgotten) {
  RandomStream random(6, "cross_validation");
  CrossValidatedInformation fraction;
  int scans = 0;
  const auto walk = [&](double distance, int facing) {
    for (double way = 0.0; way < distance; way += kStep) {
      fraction.add(scan_corridor(random, facing), Eigen::Vector3d(kStep * scans++, 0.0, 0.0));
    }
  };
  walk(6.0, 300);
  EXPECT_FALSE(fraction.leaves_direction_free());
  walk(20.0, 0);
  EXPECT_TRUE(fraction.leaves_direction_free());
}

// The first scan of an end wall holds far more real information than the average along the corridor
// before it. With the slope of the scan its step would be that many times the shift.
TEST(CrossValidatedInformation, AWallThatComesIntoViewIsNotOverstepped) {
  constexpr double kShift = 0.02;
  RandomStream random(9, "cross_validation");
  CrossValidatedInformation fraction = after(random, 0, 200, kStep);
  for (int k = 200; k < 205; ++k) {
    const HalvesInformation scan = scan_corridor(random, 60, kShift);
    fraction.add(scan, Eigen::Vector3d(kStep * k, 0.0, 0.0));
    if (fraction.leaves_direction_free()) continue;
    const PoseInformation applied = fraction.applied_to(scan);
    const double step = -applied.matrix.ldlt().solve(applied.vector)(3);
    EXPECT_GT(step, 0.5 * kShift);
    EXPECT_LT(step, 1.3 * kShift) << "scan " << k;
  }
  EXPECT_FALSE(fraction.leaves_direction_free());
}

TEST(CrossValidatedInformation, AppliesNothingAlongTheFreeDirection) {
  RandomStream random(3, "cross_validation");
  CrossValidatedInformation fraction;
  Matrix6 kept = Matrix6::Zero();
  double from_noise = 0.0;
  for (int k = 0; k < 1000; ++k) {
    const HalvesInformation scan = scan_corridor(random, 0);
    fraction.add(scan, Eigen::Vector3d(kStep * k, 0.0, 0.0));
    const PoseInformation applied = fraction.applied_to(scan);
    EXPECT_LT((applied.matrix - applied.matrix.transpose()).norm(), 1e-9 * applied.matrix.norm());
    kept += applied.matrix;
    from_noise += scan.within(3, 3);
  }
  // The axis is known within a few milliradian, so the walls leak a little.
  EXPECT_LT(kept(3, 3), 2e-2 * from_noise);
  EXPECT_GT(kept(4, 4), 0.9 * 1000.0 * 300.0 * kWeight) << "across it everything stays";
}

TEST(CrossValidatedInformation, KeepsTheRotationWhole) {
  RandomStream random(4, "cross_validation");
  const CrossValidatedInformation fraction = after(random, 0, 60, kStep);
  const HalvesInformation scan = scan_corridor(random, 0);
  const Matrix6 applied = fraction.applied_to(scan).matrix;
  const Eigen::Matrix3d kept = applied.topLeftCorner<3, 3>();
  const Eigen::Matrix3d whole = scan.within.topLeftCorner<3, 3>();
  EXPECT_LT((kept - whole).norm(), 1e-9 * whole.norm());
}

// Every scan of a standing robot sees the same noise, so that the halves may agree on it.
TEST(CrossValidatedInformation, AStandingRobotDoesNotBecomeConfident) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    RandomStream random(seed, "cross_validation.standing");
    const HalvesInformation first = scan_corridor(random, 0);
    CrossValidatedInformation fraction;
    for (int k = 0; k < 300; ++k) {
      const Eigen::Vector3d sway(0.004 * std::sin(0.3 * k), 0.003 * std::cos(0.5 * k), 0.0);
      fraction.add(first, sway);
    }
    EXPECT_TRUE(fraction.leaves_direction_free()) << "seed " << seed;
    EXPECT_LT(fraction.applied_to(first).matrix(3, 3), 0.05 * first.within(3, 3))
        << "seed " << seed;
  }
}

// What the halves have in common near the start, where each scan repeats the pattern of rings that
// is mapped, says nothing about the corridor, and must not stay in the average beyond the start.
TEST(CrossValidatedInformation, ThePatternOfTheStartConstrainsNothing) {
  CrossValidatedInformation fraction;
  for (double distance = 0.0; distance < 10.0; distance += kStep) {
    HalvesInformation scan;
    scan.within.diagonal() << 1.0, 1.0, 1.0, 1.0, 300.0, 300.0;  // walls across the corridor
    scan.across = scan.within;
    scan.across(3, 3) = 0.7 * std::exp(-distance / 0.3);
    fraction.add(scan, Eigen::Vector3d(distance, 0.0, 0.0));
    EXPECT_TRUE(fraction.leaves_direction_free()) << "after " << distance << " m";
  }
}

/// Scans of a corridor whose planes tilt towards its axis by `tilt` [rad] in the mean; the square
/// of the tilt scatters by `scatter` [rad^2] from scan to scan.
CrossValidatedInformation after_tilts(double tilt, double scatter, std::optional<double> shared) {
  RandomStream random(9, "tilts");
  CrossValidatedInformation fraction;
  for (double distance = 0.0; distance < 20.0; distance += kStep) {
    HalvesInformation scan;
    scan.within.diagonal() << 1.0, 1.0, 1.0, 1.0, 300.0, 300.0;
    scan.across = scan.within;
    scan.across(3, 3) =
        (tilt * tilt + scatter * random.normal()) * scan.within.bottomRightCorner<3, 3>().trace();
    fraction.add(scan, Eigen::Vector3d(distance, 0.0, 0.0), shared);
  }
  return fraction;
}

TEST(CrossValidatedInformation, ASharedTiltDecidesWhatIsFree) {
  constexpr double kTilt = 0.0075;
  for (const double shared : {0.006, 0.009}) {
    EXPECT_EQ(after_tilts(kTilt, 0.0, shared).leaves_direction_free(), kTilt < shared) << shared;
  }
}

// The scatter of one scan along plain walls is (3.5 mrad)^2.
TEST(CrossValidatedInformation, TheScatterOfScansDecidesWhatIsFree) {
  constexpr double kScatter = 12e-6;
  EXPECT_TRUE(after_tilts(0.0, kScatter, std::nullopt).leaves_direction_free());
  EXPECT_TRUE(after_tilts(0.002, kScatter, std::nullopt).leaves_direction_free());
  EXPECT_FALSE(after_tilts(0.0046, kScatter, std::nullopt).leaves_direction_free());
}

// Uneven walls that pass the test count with all that a scan holds, and state what both halves
// agree on; larger planes count with that, and none where a direction is free.
TEST(CrossValidatedInformation, UnevenWallsCountWhole) {
  constexpr double kScatter = 12e-6;
  RandomStream random(9, "cross_validation");
  const HalvesInformation scan = scan_corridor(random, 0);
  const auto even = after_tilts(0.002, kScatter, std::nullopt);
  const auto uneven = after_tilts(0.0046, kScatter, std::nullopt);
  const auto larger = after_tilts(0.010, kScatter, std::nullopt);
  EXPECT_FALSE(even.held_by_uneven_walls());
  EXPECT_TRUE(uneven.held_by_uneven_walls());
  EXPECT_FALSE(larger.held_by_uneven_walls());
  EXPECT_EQ(uneven.applied_to(scan).matrix, scan.within);
  EXPECT_EQ(uneven.applied_to(scan).vector, scan.within_vector);
  ASSERT_TRUE(uneven.applied_to(scan).stated);
  EXPECT_LT((*uneven.applied_to(scan).stated)(3, 3), 0.5 * scan.within(3, 3));
  EXPECT_FALSE(even.applied_to(scan).stated || larger.applied_to(scan).stated);
  EXPECT_LT(even.applied_to(scan).matrix(3, 3), 0.01 * scan.within(3, 3));
  EXPECT_LT(larger.applied_to(scan).matrix(3, 3), 0.5 * scan.within(3, 3));
}

// However much scans scatter, because a corridor changes, planes that tilt by more are real.
TEST(CrossValidatedInformation, TiltsBeyondTheLargestSharedOneAreReal) {
  constexpr double kScatter = 100e-6;
  EXPECT_TRUE(after_tilts(0.003, kScatter, std::nullopt).leaves_direction_free());
  EXPECT_FALSE(after_tilts(0.010, kScatter, std::nullopt).leaves_direction_free());
}

/// Walls on both sides of a corridor that bends about a point 10 m to the left, floor and ceiling,
/// with `noise` of the normals added to `within`, and a share `real` of it to `across`.
HalvesInformation scan_curve(double noise, double real) {
  const Eigen::Vector3d center(0.0, 10.0, 0.0);
  HalvesInformation scan;
  const auto add = [&](const Eigen::Vector3d& point, const Eigen::Vector3d& normal) {
    const Vector6 j = plane_row({normal, point, true}, point, Eigen::Matrix3d::Identity(),
                                Eigen::Vector3d::Zero())
                          .jacobian;
    scan.within += kWeight * j * j.transpose();
  };
  for (int i = -20; i <= 20; ++i) {
    const double angle = 0.02 * i;
    const Eigen::Vector3d outward(std::sin(angle), -std::cos(angle), 0.0);
    for (const double side : {-1.2, 1.2}) {
      add(center + (10.0 + side) * outward + 0.5 * (i % 3 - 1) * Eigen::Vector3d::UnitZ(), outward);
      add(center + (10.0 + 0.5 * side) * outward + side * Eigen::Vector3d::UnitZ(),
          Eigen::Vector3d::UnitZ());
    }
  }
  scan.across = scan.within;
  scan.within(3, 3) += noise;
  scan.across(3, 3) += real * noise;
  return scan;
}

// Along the arc of a curved corridor the heading turns with the position: less information about
// the position must not become more about this motion, nor about any other.
TEST(CrossValidatedInformation, ACurvedCorridorIsNotHeldToAnotherArc) {
  const HalvesInformation scan = scan_curve(100.0, 0.4);
  CrossValidatedInformation fraction;
  for (int k = 0; k < 60; ++k) fraction.add(scan, Eigen::Vector3d(kStep * k, 0.0, 0.0));
  const Matrix6 kept = fraction.applied_to(scan).matrix;
  const Vector6 arc = (Vector6() << 0.0, 0.0, 0.1, 1.0, 0.0, 0.0).finished();
  EXPECT_LT(arc.dot(kept * arc), arc.dot(scan.within * arc));
  const Eigen::SelfAdjointEigenSolver<Matrix6> more(kept - scan.within, Eigen::EigenvaluesOnly);
  EXPECT_LT(more.eigenvalues()(5), 1e-6 * scan.within.norm());
  const Eigen::SelfAdjointEigenSolver<Matrix6> information(kept, Eigen::EigenvaluesOnly);
  EXPECT_GT(information.eigenvalues()(0), -1e-6 * scan.within.norm());
}

// A smaller weight is no longer step: what is left of the information asks for the same shift.
TEST(CrossValidatedInformation, ARescaledFractionKeepsTheStep) {
  constexpr double kShift = 0.05;
  HalvesInformation scan = scan_curve(20.0, 0.4);
  const Vector6 shift = (Vector6() << 0.001, -0.002, 0.003, kShift, 0.02, -0.01).finished();
  scan.across_vector = scan.across * shift;
  CrossValidatedInformation fraction;
  for (int k = 0; k < 200; ++k) fraction.add(scan, Eigen::Vector3d(kStep * k, 0.0, 0.0));
  EXPECT_FALSE(fraction.leaves_direction_free());
  const PoseInformation applied = fraction.applied_to(scan);
  const Vector6 step = applied.matrix.ldlt().solve(applied.vector);
  EXPECT_NEAR(step(3), kShift, 1e-3 * kShift);
}

TEST(CrossValidatedInformation, BeforeTheFirstScanNothingIsConstrained) {
  const CrossValidatedInformation fraction;
  EXPECT_TRUE(fraction.leaves_direction_free());
  EXPECT_EQ(fraction.constrained().norm(), 0.0);
}

// What the matrix states and what the vector asks for agree: no bias towards no motion.
TEST(CrossValidatedInformation, AScanCorrectsTheFullShift) {
  constexpr double kShift = 0.05;
  RandomStream random(6, "cross_validation");
  HalvesInformation sum;
  for (int k = 0; k < 200; ++k) {
    const HalvesInformation scan = scan_corridor(random, 6, kShift);
    sum.within += scan.within;
    sum.across += scan.across;
    sum.within_vector += scan.within_vector;
    sum.across_vector += scan.across_vector;
  }
  const double instrumental = -sum.across.ldlt().solve(sum.across_vector)(3);
  const double biased = -sum.within.ldlt().solve(sum.within_vector)(3);
  EXPECT_NEAR(instrumental, kShift, 0.1 * kShift);
  EXPECT_LT(biased, 0.9 * kShift) << "noise information shortens the step";
}

// Where a third of the information along the axis is real, the correction scatters by as much as
// the information states: with W in place of (W + X) / 2 it would scatter by two thirds of that.
TEST(CrossValidatedInformation, TheInformationFitsTheScatterOfTheCorrection) {
  RandomStream random(8, "cross_validation");
  CrossValidatedInformation fraction;
  double scatter = 0.0;
  double stated = 0.0;
  for (int k = 0; k < 2000; ++k) {
    const HalvesInformation scan = scan_corridor(random, 1, 0.0, 1.0 / std::sqrt(kWeight));
    fraction.add(scan, Eigen::Vector3d(kStep * k, 0.0, 0.0));
    if (k < 100) continue;
    const PoseInformation applied = fraction.applied_to(scan);
    scatter += applied.vector(3) * applied.vector(3);
    stated += applied.matrix(3, 3);
  }
  EXPECT_NEAR(scatter / stated, 1.0, 0.1);
}

TEST(CrossValidation, WeakestFractionIsOneWithoutNoiseAndZeroWithNothingElse) {
  HalvesInformation scan;
  scan.within = 100.0 * Matrix6::Identity();
  scan.across = scan.within;
  EXPECT_NEAR(weakest_real_fraction(scan), 1.0, 1e-9);
  scan.across(3, 3) = 25.0;
  EXPECT_NEAR(weakest_real_fraction(scan), 0.25, 1e-9);
  scan.across(3, 3) = 0.0;
  EXPECT_NEAR(weakest_real_fraction(scan), 0.0, 1e-9);
}

TEST(CrossValidation, SchurComplementIsTheInformationWithTheRestUnknown) {
  Matrix6 A = Matrix6::Identity() * 5.0;
  RandomStream random(7, "cross_validation");
  for (int i = 0; i < 6; ++i) {
    const Vector6 v = (Vector6() << random.normal3(), random.normal3()).finished();
    A += v * v.transpose();
  }
  const Eigen::Matrix3d marginal = A.inverse().bottomRightCorner<3, 3>().inverse();
  const Eigen::Matrix3d schur = schur_complement(
      A.bottomRightCorner<3, 3>(), A.bottomLeftCorner<3, 3>(), A.topLeftCorner<3, 3>());
  EXPECT_LT((schur - marginal).cwiseAbs().maxCoeff(), 1e-6);
}

}  // namespace
}  // namespace aims
