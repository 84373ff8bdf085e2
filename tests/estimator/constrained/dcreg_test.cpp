// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/constrained/dcreg.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "tests/estimator/constrained/synthetic_scans.hpp"

namespace aims {
namespace {

using test::Correspondences;
using test::corridor;
using test::measurement_of;
using test::room;

Matrix6 random_hessian(RandomStream& random, double spread) {
  Matrix6 A;
  for (double& entry : A.reshaped()) entry = random.normal();
  Vector6 scales;
  for (double& entry : scales) entry = std::pow(10.0, random.uniform(0.0, spread));
  return A * scales.asDiagonal() * A.transpose() + Matrix6::Identity();
}

Vector6 random_vector(RandomStream& random) {
  Vector6 v;
  for (double& entry : v) entry = random.normal();
  return v;
}

int degenerate(const std::array<SchurDirection, 6>& all, int from) {
  return static_cast<int>(std::count_if(all.begin() + from, all.begin() + from + 3,
                                        [](const SchurDirection& it) { return it.degenerate; }));
}

TEST(DcReg, ConjugateGradientsGiveTheDirectSolution) {
  RandomStream random(1, "dcreg.test");
  for (int i = 0; i < 100; ++i) {
    const Matrix6 H = random_hessian(random, 3.0);
    const Vector6 b = random_vector(random);
    const Matrix6 P = preconditioner_of(schur_directions(H, {}));
    const PcgSolution pcg = solve_by_pcg(H, b, P, 1e-12, 100);
    const Vector6 direct = H.ldlt().solve(b);
    EXPECT_LT((pcg.x - direct).norm(), 1e-7 * direct.norm()) << i;
  }
}

TEST(DcReg, ThePreconditionerThatIsTheMatrixNeedsOneStep) {
  RandomStream random(2, "dcreg.test");
  const Matrix6 H = random_hessian(random, 4.0);
  const Vector6 b = random_vector(random);
  const PcgSolution pcg = solve_by_pcg(H, b, H, 1e-6, 10);
  EXPECT_EQ(pcg.iterations, 1);
  EXPECT_LT((H * pcg.x - b).norm(), 1e-6 * b.norm());
}

TEST(DcReg, NoIterationIsNeededForNothing) {
  RandomStream random(3, "dcreg.test");
  const Matrix6 H = random_hessian(random, 1.0);
  EXPECT_EQ(solve_by_pcg(H, Vector6::Zero(), H, 1e-6, 10).iterations, 0);
}

// The inverse of a Schur complement is the block of the inverse.
TEST(DcReg, EigenvaluesAreThoseWithTheOtherBlockUnknown) {
  RandomStream random(4, "dcreg.test");
  const Matrix6 H = random_hessian(random, 2.0);
  const Matrix6 covariance = H.inverse();
  for (const SchurDirection& each : schur_directions(H, {})) {
    EXPECT_NEAR(each.direction.dot(covariance * each.direction) * each.eigenvalue, 1.0, 1e-9);
  }
}

TEST(DcReg, APlainCorridorHasOneDegenerateTranslation) {
  RandomStream random(5, "dcreg.test");
  const Matrix6 H = measurement_of(corridor(400, random), 0.01).matrix;
  const auto all = schur_directions(H, {});
  EXPECT_EQ(degenerate(all, 3), 1);
  EXPECT_TRUE(all[3].degenerate);
  EXPECT_NEAR(std::abs(all[3].direction(3)), 1.0, 1e-6);
}

TEST(DcReg, ARoomHasNoDegenerateDirection) {
  RandomStream random(6, "dcreg.test");
  const Matrix6 H = measurement_of(room(400, random), 0.01).matrix;
  const auto all = schur_directions(H, {});
  EXPECT_EQ(degenerate(all, 0) + degenerate(all, 3), 0);
  EXPECT_EQ(clamping_of(all), Matrix6::Zero());
}

TEST(DcReg, ClampsDegenerateDirectionsToTheTarget) {
  RandomStream random(7, "dcreg.test");
  const DcRegConfig config{.condition_threshold = 20.0, .condition_target = 5.0};
  const auto all = schur_directions(measurement_of(corridor(400, random), 0.01).matrix, config);
  for (std::size_t i = 0; i < 6; ++i) {
    const double largest = all[i < 3 ? 2 : 5].eigenvalue;
    EXPECT_EQ(all[i].degenerate, largest > 20.0 * all[i].eigenvalue) << i;
    EXPECT_NEAR(all[i].clamped, all[i].degenerate ? largest / 5.0 : all[i].eigenvalue,
                1e-9 * largest)
        << i;
  }
}

TEST(DcReg, HasTheMinimizerOfThePlainUpdate) {
  RandomStream random(8, "dcreg.test");
  for (int i = 0; i < 20; ++i) {
    const Belief prior = test::vague_belief(random);
    const PoseMeasurement scan =
        measurement_of(corridor(400, random, 0.01 * random_vector(random)), 0.1);
    const GainMask mask{.legs = i % 2 == 0};
    const Belief plain = fuse(prior, prior.state, scan, mask);
    const RuledUpdate update = DcReg({.tolerance = 1e-12, .max_iterations = 100})
                                   .fuse(prior, prior.state, {scan, mask}, {});
    const double moved = boxminus(plain.state, prior.state).norm();
    EXPECT_LT(boxminus(update.belief.state, plain.state).norm(), 1e-6 * moved) << i;
    EXPECT_LT((update.belief.covariance - plain.covariance).norm(), 1e-6 * plain.covariance.norm());
    EXPECT_TRUE(update.verdict.translation);
  }
}

TEST(DcReg, OfItsTenIterationsFewRemainToTheMinimizer) {
  RandomStream random(9, "dcreg.test");
  for (int i = 0; i < 20; ++i) {
    const Belief prior = test::vague_belief(random);
    const PoseMeasurement scan =
        measurement_of(corridor(400, random, 0.01 * random_vector(random)), 0.1);
    const Belief plain = fuse(prior, prior.state, scan);
    const Belief update = DcReg({}).fuse(prior, prior.state, {scan, {}}, {}).belief;
    EXPECT_LT((update.state.position - plain.state.position).norm(), 1e-4) << i;
  }
}

TEST(DcReg, RegularizingHoldsDegenerateDirectionsOnly) {
  RandomStream random(10, "dcreg.test");
  Belief prior;
  prior.covariance *= 0.01;
  Vector6 error = Vector6::Zero();
  error.tail<3>().setConstant(0.01);
  Correspondences scan = corridor(400, random, error);
  test::add_end_wall(scan, 20, random, error);
  const DcRegConfig config{.tolerance = 1e-12, .max_iterations = 100, .regularize = true};
  const PoseMeasurement measured = measurement_of(scan, 0.01);
  const auto all = schur_directions(measured.matrix, config);
  ASSERT_TRUE(all[3].degenerate);
  const Belief belief = DcReg(config).fuse(prior, prior.state, {measured, {}}, scan).belief;
  // The prior is far weaker than the clamped information.
  EXPECT_NEAR(belief.state.position.x(), -0.01 * all[3].eigenvalue / all[3].clamped, 1e-3);
  EXPECT_NEAR(belief.state.position.y(), -0.01, 2e-4);
  EXPECT_NEAR(belief.state.position.z(), -0.01, 2e-4);
}

}  // namespace
}  // namespace aims
