// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/baselines/pose_graph/factor_graph.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <vector>

#include "core/random.hpp"
#include "estimator/baselines/pose_graph/pose_graph.hpp"

namespace aims::pose_graph {
namespace {

using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr double kAlways = 1e-12;  ///< threshold at which every variable is relinearized
constexpr double kNever = 1e6;

MatrixXd weight(double sigma) { return MatrixXd::Identity(6, 6) / sigma; }

/// A chain of noisy relative poses with a loop.
struct Chain {
  std::vector<Value> initial;
  std::vector<Factor> factors;
};

Chain random_chain(int length, std::uint64_t seed) {
  RandomStream random(seed, "factor_graph_test");
  const auto noisy = [&](const Pose& pose, double sigma) {
    return Pose{pose.rotation * so3_exp(sigma * random.normal3()),
                pose.translation + sigma * random.normal3()};
  };
  Chain chain;
  std::vector<Pose> truth = {Pose()};
  const Pose step{so3_exp({0.02, -0.01, 0.15}), {1.0, 0.1, 0.02}};
  chain.factors.push_back(pose_prior(0, Pose(), weight(0.01)));
  chain.initial.push_back(noisy(Pose(), 0.05));
  for (int i = 1; i < length; ++i) {
    truth.push_back(truth.back() * step);
    chain.initial.push_back(noisy(truth.back(), 0.1));
    chain.factors.push_back(relative_pose(i - 1, i, noisy(step, 0.02), weight(0.02)));
  }
  chain.factors.push_back(
      relative_pose(length - 1, 0, noisy(truth.back().inverse(), 0.01), weight(0.01)));
  return chain;
}

void fill(FactorGraph& graph, const Chain& chain) {
  for (const Value& value : chain.initial) graph.add_variable(value);
  for (const Factor& factor : chain.factors) graph.add_factor(factor);
}

/// One dense Gauss-Newton step over everything; `information` is that at the given values.
std::vector<Value> dense_step(const std::vector<Value>& values, const std::vector<Factor>& factors,
                              MatrixXd& information) {
  std::vector<int> offsets;
  int size = 0;
  for (const Value& value : values) {
    offsets.push_back(size);
    size += dimension_of(value);
  }
  information = MatrixXd::Zero(size, size);
  VectorXd right = VectorXd::Zero(size);
  for (const Factor& factor : factors) {
    std::vector<Value> involved;
    for (const int key : factor.variables) involved.push_back(values[key]);
    const Linearization at = factor.model(involved);
    MatrixXd J = MatrixXd::Zero(at.residual.size(), size);
    for (std::size_t i = 0; i < factor.variables.size(); ++i) {
      J.middleCols(offsets[factor.variables[i]], at.jacobians[i].cols()) = at.jacobians[i];
    }
    J = (factor.sqrt_information * J).eval();
    information += J.transpose() * J;
    right -= J.transpose() * (factor.sqrt_information * at.residual);
  }
  const VectorXd steps = information.ldlt().solve(right);
  std::vector<Value> next;
  for (std::size_t i = 0; i < values.size(); ++i) {
    next.push_back(moved(values[i], steps.segment(offsets[i], dimension_of(values[i]))));
  }
  return next;
}

void expect_same_poses(const FactorGraph& graph, const std::vector<Value>& values,
                       double tolerance) {
  for (int i = 0; i < static_cast<int>(values.size()); ++i) {
    const Pose found = std::get<Pose>(graph.estimate(i));
    const Pose expected = std::get<Pose>(values[i]);
    EXPECT_LT((found.translation - expected.translation).norm(), tolerance) << i;
    EXPECT_LT(so3_log(found.rotation.conjugate() * expected.rotation).norm(), tolerance) << i;
  }
}

TEST(FactorGraph, AnUpdateIsOneStepOfTheDenseProblem) {
  const Chain chain = random_chain(12, 1);
  FactorGraph graph(kNever);
  fill(graph, chain);
  ASSERT_TRUE(graph.update());
  MatrixXd information;
  expect_same_poses(graph, dense_step(chain.initial, chain.factors, information), 1e-8);
  const MatrixXd covariance = information.inverse();
  const auto marginal = graph.marginal_covariance(7);
  ASSERT_TRUE(marginal);
  EXPECT_LT((*marginal - covariance.block(42, 42, 6, 6)).norm(), 1e-9 * covariance.norm());
}

TEST(FactorGraph, UpdatesConvergeToTheDenseSolution) {
  const Chain chain = random_chain(12, 2);
  FactorGraph graph(kAlways);
  fill(graph, chain);
  std::vector<Value> values = chain.initial;
  MatrixXd information;
  for (int i = 0; i < 8; ++i) {
    ASSERT_TRUE(graph.update());
    values = dense_step(values, chain.factors, information);
  }
  expect_same_poses(graph, values, 1e-8);
}

TEST(FactorGraph, WhatArrivesLaterYieldsTheSameSolution) {
  const Chain chain = random_chain(10, 3);
  FactorGraph at_once(kAlways);
  fill(at_once, chain);
  for (int i = 0; i < 10; ++i) ASSERT_TRUE(at_once.update());
  FactorGraph one_by_one(kAlways);
  for (std::size_t i = 0; i < chain.initial.size(); ++i) {
    one_by_one.add_variable(chain.initial[i]);
    one_by_one.add_factor(chain.factors[i]);
    ASSERT_TRUE(one_by_one.update());
  }
  one_by_one.add_factor(chain.factors.back());
  for (int i = 0; i < 10; ++i) ASSERT_TRUE(one_by_one.update());
  std::vector<Value> expected;
  for (int i = 0; i < at_once.variables(); ++i) expected.push_back(at_once.estimate(i));
  expect_same_poses(one_by_one, expected, 1e-8);
}

/// A prior of which the linearization is wrong by a factor that grows with the distance.
TEST(FactorGraph, AVariableIsRelinearizedOnceItHasMovedAsFarAsTheThreshold) {
  int linearizations = 0;
  const auto model = [&](std::span<const Value> values) {
    ++linearizations;
    return Linearization{std::get<Vector3d>(values[0]) - Vector3d(0.5, 0.0, 0.0),
                         {MatrixXd::Identity(3, 3)}};
  };
  for (const auto& [threshold, expected] : {std::pair(0.6, 1), std::pair(0.4, 2)}) {
    linearizations = 0;
    FactorGraph graph(threshold);
    graph.add_variable(Vector3d(0.0, 0.0, 0.0));
    graph.add_factor({{0}, MatrixXd::Identity(3, 3), model});
    for (int i = 0; i < 4; ++i) ASSERT_TRUE(graph.update());
    EXPECT_EQ(linearizations, expected) << threshold;
    EXPECT_NEAR(std::get<Vector3d>(graph.estimate(0)).x(), 0.5, 1e-12);
  }
}

TEST(FactorGraph, AVariableWithoutFactorsHasNoSolution) {
  FactorGraph graph(0.1);
  graph.add_variable(Pose());
  graph.add_variable(Pose());
  graph.add_factor(pose_prior(0, Pose(), weight(1.0)));
  EXPECT_FALSE(graph.update());
}

Pose at(double x, double y) { return {Eigen::Quaterniond::Identity(), {x, y, 0.0}}; }

TEST(PoseGraph, WithoutLoopsKeyframesStay) {
  PoseGraph graph{PoseGraphConfig()};
  for (int i = 0; i < 20; ++i) {
    EXPECT_FALSE(graph.add(at(i, 0.1 * i), {}));
    EXPECT_LT((graph.pose(i).translation - Vector3d(i, 0.1 * i, 0.0)).norm(), 1e-4);
  }
}

TEST(PoseGraph, ALoopSpreadsItsErrorOverTheKeyframes) {
  PoseGraph graph{PoseGraphConfig()};
  // Out 10 m and back, with 0.4 m too much on the way back.
  for (int i = 0; i <= 10; ++i) graph.add(at(i, 0.0), {});
  for (int i = 1; i <= 10; ++i) graph.add(at(10.0 - 1.04 * i, 0.0), {});
  const Loop loop{20, 0, at(0.0, 0.0), 1e-6};
  EXPECT_TRUE(graph.add(at(-0.4, 0.5), {loop}));
  EXPECT_NEAR(graph.pose(20).translation.x(), graph.pose(0).translation.x(), 1e-3);
  const double out = graph.pose(10).translation.x() - graph.pose(0).translation.x();
  EXPECT_NEAR(out, 10.0 + 0.2, 0.01) << "half of the error lies before the turn";
}

}  // namespace
}  // namespace aims::pose_graph
