// SPDX-License-Identifier: BSD-3-Clause
#include "bench/tuning/surrogate.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

#include "bench/tuning/design.hpp"
#include "core/random.hpp"

namespace aims {
namespace {

using Function = std::function<double(const Eigen::VectorXd&)>;

/// Points of a Sobol sequence in the unit cube.
Eigen::MatrixXd cube(int points, int inputs) {
  std::vector<ParameterRange> ranges(static_cast<std::size_t>(inputs), {"x", 0.0, 1.0, 0, false});
  const auto rows = design(DesignKind::kSobol, ranges, points, 1);
  Eigen::MatrixXd matrix(points, inputs);
  for (int row = 0; row < points; ++row) {
    for (int i = 0; i < inputs; ++i) {
      matrix(row, i) = rows[static_cast<std::size_t>(row)][static_cast<std::size_t>(i)];
    }
  }
  return matrix;
}

Surrogate fitted(const Function& function, int points, int inputs, double noise = 0.0) {
  const Eigen::MatrixXd x = cube(points, inputs);
  Eigen::VectorXd values(points);
  RandomStream random = rng(1, "test.noise");
  for (int row = 0; row < points; ++row) {
    values(row) = function(x.row(row).transpose()) + noise * random.normal();
  }
  auto surrogate = Surrogate::fit(x, values);
  EXPECT_TRUE(surrogate) << surrogate.error().message;
  return std::move(*surrogate);
}

/// Ishigami and Homma 1990, a = 7, b = 0.1, scaled to the unit cube.
double ishigami(const Eigen::VectorXd& u) {
  const Eigen::VectorXd x = (2.0 * u.array() - 1.0) * std::numbers::pi;
  return std::sin(x(0)) + 7.0 * std::pow(std::sin(x(1)), 2) +
         0.1 * std::pow(x(2), 4) * std::sin(x(0));
}

TEST(Surrogate, FindsTheIndicesOfIshigamisFunction) {
  const double pi4 = std::pow(std::numbers::pi, 4);
  const double first = 0.5 * std::pow(1.0 + 0.1 * pi4 / 5.0, 2);
  const double second = 49.0 / 8.0;
  const double interaction = 0.01 * pi4 * pi4 * (1.0 / 18.0 - 1.0 / 50.0);
  const double variance = first + second + interaction;
  const Surrogate surrogate = fitted(ishigami, 256, 3);
  EXPECT_GT(surrogate.explained(), 0.98);
  const SobolIndices& indices = surrogate.indices();
  EXPECT_NEAR(indices.first[0], first / variance, 0.02);
  EXPECT_NEAR(indices.first[1], second / variance, 0.02);
  EXPECT_NEAR(indices.first[2], 0.0, 0.01);
  EXPECT_NEAR(indices.total[0], (first + interaction) / variance, 0.02);
  EXPECT_NEAR(indices.total[1], second / variance, 0.02);
  EXPECT_NEAR(indices.total[2], interaction / variance, 0.02);
  EXPECT_NEAR(indices.second(0, 2), interaction / variance, 0.02);
  EXPECT_NEAR(indices.second(0, 1), 0.0, 0.01);
}

TEST(Surrogate, OfASumHasNoInteractions) {
  const Surrogate surrogate = fitted(
      [](const Eigen::VectorXd& u) { return 1.0 * u(0) + 2.0 * u(1) + 4.0 * u(2) + 3.0; }, 32, 3);
  const SobolIndices& indices = surrogate.indices();
  const double squares[] = {1.0 / 21.0, 4.0 / 21.0, 16.0 / 21.0};
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(indices.first[i], squares[i], 1e-6);
    EXPECT_NEAR(indices.total[i], squares[i], 1e-6);
  }
  EXPECT_LT(indices.second.cwiseAbs().maxCoeff(), 1e-6);
  EXPECT_LT(surrogate.error(), 1e-6);
}

TEST(Surrogate, OfAProductHasNothingElse) {
  const Surrogate surrogate = fitted(
      [](const Eigen::VectorXd& u) { return (2.0 * u(0) - 1.0) * (2.0 * u(1) - 1.0); }, 48, 2);
  EXPECT_NEAR(surrogate.indices().first[0], 0.0, 1e-6);
  EXPECT_NEAR(surrogate.indices().total[0], 1.0, 1e-6);
  EXPECT_NEAR(surrogate.indices().second(0, 1), 1.0, 1e-6);
}

TEST(Surrogate, SeesThatAParameterIsInertThroughNoise) {
  const Surrogate surrogate =
      fitted([](const Eigen::VectorXd& u) { return std::exp(u(0)) + u(0) * u(2); }, 128, 4, 0.05);
  for (const std::size_t inert : {1U, 3U}) {
    EXPECT_LT(surrogate.indices().total[inert], 0.03) << inert;
    EXPECT_LT(surrogate.indices().total_interval[inert].high.value_or(1.0), 0.05) << inert;
  }
  EXPECT_GT(surrogate.indices().total_interval[0].low.value_or(0.0), 0.5);
}

TEST(Surrogate, ItsErrorIsThatAtNewPoints) {
  constexpr double kNoise = 0.5;
  const Surrogate surrogate = fitted(ishigami, 256, 3, kNoise);
  RandomStream random = rng(2, "test.points");
  double squares = 0.0;
  constexpr int kNew = 2000;
  for (int k = 0; k < kNew; ++k) {
    const Eigen::VectorXd point =
        Eigen::Vector3d(random.uniform(), random.uniform(), random.uniform());
    squares += std::pow(surrogate.at(point) - ishigami(point) - kNoise * random.normal(), 2);
  }
  const double error = std::sqrt(squares / kNew);
  EXPECT_GT(surrogate.error(), 0.8 * error);
  EXPECT_LT(surrogate.error(), 1.4 * error);
}

TEST(Surrogate, KnowsWhereItHasSeenNothing) {
  // A narrow crowd, as of an optimizer, about a corner of the square.
  Eigen::MatrixXd x = 0.2 * cube(64, 2);
  Eigen::VectorXd values(64);
  RandomStream noise = rng(1, "test.noise");
  for (int row = 0; row < 64; ++row)
    values(row) = std::exp(3.0 * x(row, 0)) + x(row, 1) + 0.05 * noise.normal();
  const auto crowd = Surrogate::fit(x, values);
  ASSERT_TRUE(crowd);
  for (int row = 0; row < 64; ++row) EXPECT_FALSE(crowd->extrapolates(x.row(row).transpose()));
  EXPECT_FALSE(crowd->extrapolates(Eigen::Vector2d(0.1, 0.1)));
  EXPECT_TRUE(crowd->extrapolates(Eigen::Vector2d(0.9, 0.1)));

  const Surrogate filled = fitted(ishigami, 256, 3);
  EXPECT_FALSE(filled.extrapolates(Eigen::Vector3d(0.5, 0.5, 0.5)));
  EXPECT_FALSE(filled.extrapolates(Eigen::Vector3d(0.0, 0.5, 1.0)));
}

TEST(Surrogate, OfNoiseAloneExplainsNothing) {
  const Surrogate surrogate = fitted([](const Eigen::VectorXd&) { return 1.0; }, 100, 5, 1.0);
  EXPECT_LT(surrogate.explained(), 0.1);
}

TEST(Surrogate, OfAConstantIsTheConstant) {
  const Surrogate surrogate = fitted([](const Eigen::VectorXd&) { return 7.0; }, 20, 3);
  EXPECT_NEAR(surrogate.at(Eigen::Vector3d(0.1, 0.9, 0.4)), 7.0, 1e-9);
  EXPECT_EQ(surrogate.explained(), 1.0);
  EXPECT_EQ(surrogate.indices().total[0], 0.0);
}

TEST(Surrogate, BendsNothingBetweenTwoLevels) {
  Eigen::MatrixXd x(18, 2);
  Eigen::VectorXd values(18);
  for (int row = 0; row < 18; ++row) {
    x.row(row) << row % 2, (row / 2) / 8.0;
    values(row) = 2.0 * x(row, 0) + x(row, 1) * x(row, 1);
  }
  const auto surrogate = Surrogate::fit(x, values);
  ASSERT_TRUE(surrogate);
  for (const double u : {0.1, 0.3, 0.5, 0.8}) {
    const double line = (1.0 - u) * surrogate->at(Eigen::Vector2d(0.0, 0.25)) +
                        u * surrogate->at(Eigen::Vector2d(1.0, 0.25));
    EXPECT_NEAR(surrogate->at(Eigen::Vector2d(u, 0.25)), line, 1e-9);
  }
}

TEST(Surrogate, FitsAGridOfFewLevels) {
  Eigen::MatrixXd x(15, 2);
  Eigen::VectorXd values(15);
  for (int row = 0; row < 15; ++row) {
    x.row(row) << (row % 3) / 2.0, (row / 3) / 4.0;
    values(row) = x(row, 0) * x(row, 0) - x(row, 1);
  }
  const auto surrogate = Surrogate::fit(x, values);
  ASSERT_TRUE(surrogate);
  EXPECT_NEAR(surrogate->at(Eigen::Vector2d(0.5, 0.25)), 0.0, 1e-6);
}

TEST(Surrogate, RefusesWhatItCannotFit) {
  const Eigen::MatrixXd x = cube(20, 2);
  EXPECT_FALSE(Surrogate::fit(x.topRows(4), Eigen::VectorXd::Zero(4)));
  EXPECT_FALSE(Surrogate::fit(x, Eigen::VectorXd::Zero(19)));
  Eigen::VectorXd values = Eigen::VectorXd::Zero(20);
  values(3) = std::nan("");
  EXPECT_FALSE(Surrogate::fit(x, values));
}

}  // namespace
}  // namespace aims
