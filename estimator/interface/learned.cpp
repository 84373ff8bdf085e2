// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/interface/learned.hpp"

#include <Eigen/Cholesky>

namespace aims {

std::vector<double> numbers_of(const Gaussian& gaussian) {
  std::vector<double> numbers(gaussian.mean.begin(), gaussian.mean.end());
  for (Eigen::Index row = 0; row < gaussian.mean.size(); ++row) {
    for (Eigen::Index column = row; column < gaussian.mean.size(); ++column) {
      numbers.push_back(gaussian.covariance(row, column));
    }
  }
  return numbers;
}

std::optional<Gaussian> gaussian_of(std::span<const double> numbers, int size) {
  if (static_cast<int>(numbers.size()) != count_of_numbers(size)) return std::nullopt;
  Gaussian gaussian{Eigen::VectorXd(size), Eigen::MatrixXd(size, size)};
  auto next = numbers.begin();
  for (int i = 0; i < size; ++i) gaussian.mean(i) = *next++;
  for (int row = 0; row < size; ++row) {
    for (int column = row; column < size; ++column) {
      gaussian.covariance(row, column) = gaussian.covariance(column, row) = *next++;
    }
  }
  const Eigen::LLT<Eigen::MatrixXd> root(gaussian.covariance);
  if (root.info() != Eigen::Success) return std::nullopt;
  return gaussian;
}

Gaussian posterior_of(const LearnedQuantity& quantity) {
  const Eigen::VectorXd precision = quantity.prior_sigma.cwiseAbs2().cwiseInverse();
  Eigen::MatrixXd information = quantity.information;
  information.diagonal() += precision;
  const Eigen::MatrixXd covariance = information.inverse();
  return {covariance * (quantity.vector + precision.cwiseProduct(quantity.prior)),
          0.5 * (covariance + covariance.transpose())};
}

}  // namespace aims
