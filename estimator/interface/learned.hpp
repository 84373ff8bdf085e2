// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace aims {

/// Values of a few numbers with their covariance.
struct Gaussian {
  Eigen::VectorXd mean;
  Eigen::MatrixXd covariance;
};

/// The values, then the upper triangle of the covariance, row by row.
std::vector<double> numbers_of(const Gaussian& gaussian);

/// The Gaussian of `size` values from `numbers_of`; nothing for another count of numbers, or when
/// the covariance is not positive definite.
std::optional<Gaussian> gaussian_of(std::span<const double> numbers, int size);

/// How many numbers `numbers_of` makes of `size` values.
constexpr int count_of_numbers(int size) { return size + size * (size + 1) / 2; }

/// What the data of a run say about a quantity of the robot or its sensors.
struct LearnedQuantity {
  std::string name;                  ///< e.g. "legs_by_feet"
  std::vector<std::string> entries;  ///< names with unit, e.g. "scale x [-]"
  Eigen::MatrixXd information;       ///< from the data alone, without the prior
  Eigen::VectorXd vector;            ///< `information` times the value that fits the data best
  Eigen::VectorXd prior;             ///< value before any data
  Eigen::VectorXd prior_sigma;       ///< its deviation
  bool varies_by_run = false;        ///< turn-on biases, clocks: another value after a restart
};

/// The value that data and prior make most probable, with its covariance.
Gaussian posterior_of(const LearnedQuantity& quantity);

}  // namespace aims
