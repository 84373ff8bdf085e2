// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/baselines/lins/filter.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <limits>

#include "tests/estimator/baselines/lins/random_states.hpp"

namespace aims::lins {
namespace {

constexpr unsigned kSeed = 11;

using features::DistanceRow;
using features::FeatureMatches;

/// Points in the planes and on the lines where they lie at `truth`.
FeatureMatches matches_at(const Pose& truth, int planes, int lines, std::mt19937& random) {
  FeatureMatches matches;
  for (int i = 0; i < planes; ++i) {
    features::PlaneMatch match;
    match.point = test::random_vector(random, 4.0);
    match.normal = test::random_vector(random, 1.0).normalized();
    match.offset = -match.normal.dot(truth * match.point);
    matches.planes.push_back(match);
  }
  for (int i = 0; i < lines; ++i) {
    features::LineMatch match;
    match.point = test::random_vector(random, 4.0);
    match.direction = test::random_vector(random, 1.0).normalized();
    match.origin = truth * match.point + test::random_vector(random, 1.0).x() * match.direction;
    matches.lines.push_back(match);
  }
  return matches;
}

DistancesAt unweighted(const FeatureMatches& matches) {
  return [&matches](const State& x, int) { return distances_at(x.motion, matches, {}); };
}

// Without the inverse right Jacobian it is the derivative by a disturbance on the right.
TEST(LinsUpdate, JacobianMatchesFiniteDifferences) {
  constexpr double kStep = 1e-6;
  std::mt19937 random(kSeed);
  for (int i = 0; i < 10; ++i) {
    const State x = test::random_state(random);
    const FeatureMatches matches = matches_at(Pose(), 1, 0, random);
    const features::PlaneMatch& plane = matches.planes.front();
    Vector6 h = distance_jacobian(plane.point, plane.normal, x.motion.rotation);
    h.tail<3>() =
        so3_right_jacobian(so3_log(x.motion.rotation)).transpose() * Eigen::Vector3d(h.tail<3>());
    for (int k = 0; k < 3; ++k) {
      for (const auto& [row, block] : {std::pair(k, Error::kPosition), {k + 3, Error::kRotation}}) {
        const ErrorVector step = kStep * ErrorVector::Unit(block + k);
        const double slope = (distance_row(plane, plus(x, step).motion).distance -
                              distance_row(plane, plus(x, -step).motion).distance) /
                             (2.0 * kStep);
        EXPECT_NEAR(h(row), slope, 1e-7) << "seed " << kSeed << ", case " << i;
      }
    }
  }
}

TEST(LinsUpdate, SumsWeightedDistances) {
  std::mt19937 random(kSeed);
  const FeatureMatches matches = matches_at(Pose(), 20, 20, random);
  const Pose motion{so3_exp({0.01, -0.02, 0.015}), {0.03, 0.05, -0.04}};
  const Distances sum = distances_at(motion, matches, {1.8, 0.1});
  Eigen::MatrixXd H(40, 6);
  Eigen::VectorXd d(40);
  int row = 0;
  const auto add = [&](const auto& match, double scale) {
    const DistanceRow each = distance_row(match, motion);
    const double weight = 1.0 - 1.8 * std::abs(each.distance) / scale;
    if (weight <= 0.1) return;
    H.row(row) = weight * distance_jacobian(match.point, each.gradient, motion.rotation);
    d(row++) = weight * each.distance;
  };
  for (const auto& match : matches.planes) add(match, std::sqrt((motion * match.point).norm()));
  for (const auto& match : matches.lines) add(match, 1.0);
  ASSERT_GT(row, 30);
  H.conservativeResize(row, 6);
  d.conservativeResize(row);
  EXPECT_TRUE(sum.HtH.isApprox(H.transpose() * H, 1e-12)) << "seed " << kSeed;
  EXPECT_TRUE(sum.Htd.isApprox(H.transpose() * d, 1e-12));
  EXPECT_NEAR(sum.squared_norm, d.squaredNorm(), 1e-12);
  EXPECT_EQ(sum.gradients.size(), static_cast<std::size_t>(row));
  EXPECT_EQ(sum.planes, 20);
  EXPECT_EQ(sum.lines, 20);
}

// The textbook update with a row per distance, and Joseph's form of the covariance.
TEST(LinsUpdate, OneIterationIsTheKalmanUpdate) {
  std::mt19937 random(kSeed);
  for (const int count : {4, 100}) {  // fewer and more rows than states
    const Belief prior{test::random_state(random), test::random_covariance(random, 0.05)};
    const FeatureMatches matches = matches_at(prior.state.motion, count, 0, random);
    const State truth = plus(prior.state, test::random_error(random, 0.01));
    FeatureMatches moved = matches;
    for (auto& match : moved.planes) match.offset = -match.normal.dot(truth.motion * match.point);
    Eigen::MatrixXd H = Eigen::MatrixXd::Zero(count, Error::kSize);
    Eigen::VectorXd d(count);
    for (int i = 0; i < count; ++i) {
      const auto& match = moved.planes[static_cast<std::size_t>(i)];
      const DistanceRow row = distance_row(match, prior.state.motion);
      const Vector6 h = distance_jacobian(match.point, row.gradient, prior.state.motion.rotation);
      H.row(i).segment<3>(Error::kPosition) = h.head<3>();
      H.row(i).segment<3>(Error::kRotation) = h.tail<3>();
      d(i) = row.distance;
    }
    const UpdateConfig config{.deviation = 0.02, .max_iterations = 1};
    const Eigen::MatrixXd R = 4e-4 * Eigen::MatrixXd::Identity(count, count);
    const ErrorMatrix& P = prior.covariance;
    const Eigen::MatrixXd K = P * H.transpose() * (H * P * H.transpose() + R).inverse();
    const ErrorMatrix rest = ErrorMatrix::Identity() - K * H;
    const ErrorMatrix expected = rest * P * rest.transpose() + K * R * K.transpose();
    const Update update = iterated_update(prior, unweighted(moved), config);
    EXPECT_EQ(update.iterations, 1);
    EXPECT_LT((minus(update.belief.state, prior.state) + K * d).norm(), 1e-8)
        << "seed " << kSeed << ", " << count << " rows";
    EXPECT_LT((update.belief.covariance - expected).norm(), 1e-8 * expected.norm());
  }
}

/// What the update is to minimize.
double cost(const FeatureMatches& matches, const Belief& prior, const State& x, double deviation) {
  const ErrorVector moved = minus(x, prior.state);
  return moved.dot(prior.covariance.inverse() * moved) +
         distances_at(x.motion, matches, {}).squared_norm / (deviation * deviation);
}

/// The least cost, by steps along numerical derivatives.
State batch_solution(const FeatureMatches& matches, const Belief& prior, double deviation) {
  constexpr double kStep = 1e-4;
  State x = prior.state;
  for (int i = 0; i < 20; ++i) {
    const auto at = [&](const ErrorVector& e) {
      return cost(matches, prior, plus(x, e), deviation);
    };
    ErrorVector gradient;
    ErrorMatrix curvature;
    for (int j = 0; j < Error::kSize; ++j) {
      const ErrorVector a = kStep * ErrorVector::Unit(j);
      gradient(j) = (at(a) - at(-a)) / (2.0 * kStep);
      for (int k = 0; k < Error::kSize; ++k) {
        const ErrorVector b = kStep * ErrorVector::Unit(k);
        curvature(j, k) = (at(a + b) - at(a - b) - at(b - a) + at(-a - b)) / (4.0 * kStep * kStep);
      }
    }
    x = plus(x, -curvature.ldlt().solve(gradient));
  }
  return x;
}

TEST(LinsUpdate, IterationsReachTheBatchSolution) {
  std::mt19937 random(kSeed);
  for (int i = 0; i < 3; ++i) {
    // Small rotations: as published the covariance of the prior is not carried to the solution.
    const Belief prior{test::random_state(random, 0.002), test::random_covariance(random, 0.005)};
    const State truth = plus(prior.state, test::random_error(random, 0.005));
    FeatureMatches matches = matches_at(truth.motion, 20, 0, random);
    for (auto& match : matches.planes) match.offset += 0.01 * test::random_vector(random, 1.0).x();
    const UpdateConfig config{.convergence = 1e-9};
    const Update update = iterated_update(prior, unweighted(matches), config);
    EXPECT_TRUE(update.converged);
    EXPECT_GT(update.iterations, 1);
    const State expected = batch_solution(matches, prior, config.deviation);
    const double moved = minus(expected, prior.state).norm();
    EXPECT_LT(minus(update.belief.state, expected).norm(), 0.02 * moved)
        << "seed " << kSeed << ", case " << i;
  }
}

TEST(LinsUpdate, ASmallStepEndsIt) {
  std::mt19937 random(kSeed);
  const Belief prior{State(), 1e-4 * ErrorMatrix::Identity()};
  const FeatureMatches matches = matches_at(Pose(), 50, 0, random);
  const Update update = iterated_update(prior, unweighted(matches), UpdateConfig());
  EXPECT_TRUE(update.converged);
  EXPECT_EQ(update.iterations, 1);
}

TEST(LinsUpdate, GrowingDistancesAreADivergenceThatLeavesThePrior) {
  std::mt19937 random(kSeed);
  const Belief prior{test::random_state(random), test::random_covariance(random, 0.1)};
  const auto distances = [](double growth) -> DistancesAt {
    return [growth](const State&, int iteration) {
      Distances sum;
      sum.HtH = 100.0 * Matrix6::Identity();
      sum.Htd = Vector6::Constant(std::pow(growth, iteration));
      sum.squared_norm = std::pow(growth, 2 * iteration);
      return sum;
    };
  };
  const Update diverged = iterated_update(prior, distances(11.0), UpdateConfig());
  EXPECT_TRUE(diverged.diverged);
  EXPECT_EQ(diverged.iterations, 2);
  EXPECT_EQ(minus(diverged.belief.state, prior.state).norm(), 0.0);
  EXPECT_EQ(diverged.belief.covariance, prior.covariance);
  EXPECT_FALSE(iterated_update(prior, distances(9.0), {.max_iterations = 5}).diverged);
}

TEST(LinsUpdate, AStepThatIsNotFiniteIsADivergence) {
  const Belief prior{State(), 1e-4 * ErrorMatrix::Identity()};
  const Update update = iterated_update(
      prior,
      [](const State&, int) {
        Distances sum;
        sum.Htd.setConstant(std::numeric_limits<double>::quiet_NaN());
        return sum;
      },
      UpdateConfig());
  EXPECT_TRUE(update.diverged);
  EXPECT_EQ(minus(update.belief.state, prior.state).norm(), 0.0);
}

}  // namespace
}  // namespace aims::lins
