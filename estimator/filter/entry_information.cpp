// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/filter/entry_information.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>

namespace aims {
namespace {

/// Directions in which the data hold less than this part of the known information are not tested.
constexpr double kNotDetermined = 1e-6;

}  // namespace

Eigen::VectorXd entries_of(const NominalState& state, int offset, int size) {
  return boxminus(state, NominalState()).segment(offset, size);
}

EntryInformation::EntryInformation(int offset, int size)
    : offset_(offset),
      matrix_(Eigen::MatrixXd::Zero(size, size)),
      vector_(Eigen::VectorXd::Zero(size)) {}

void EntryInformation::add(const Belief& before, const Belief& after) {
  const auto size = static_cast<int>(vector_.size());
  const auto information = [&](const Belief& belief) -> Eigen::MatrixXd {
    return belief.covariance.block(offset_, offset_, size, size).inverse();
  };
  const Eigen::MatrixXd less = information(before);
  const Eigen::MatrixXd more = information(after);
  const Eigen::MatrixXd gained = more - less;
  const Eigen::VectorXd vector = more * entries_of(after.state, offset_, size) -
                                 less * entries_of(before.state, offset_, size);
  if (!gained.allFinite() || !vector.allFinite()) return;
  matrix_ += 0.5 * (gained + gained.transpose());
  vector_ += vector;
}

double disagreement(const EntryInformation& data, const Eigen::VectorXd& mean,
                    const Eigen::MatrixXd& covariance) {
  const Eigen::MatrixXd& I = data.matrix();
  const Eigen::VectorXd u = data.vector() - I * mean;
  const Eigen::MatrixXd known = covariance.inverse();
  const Eigen::VectorXd difference = (I + kNotDetermined * known).ldlt().solve(u);
  const Eigen::MatrixXd identity = Eigen::MatrixXd::Identity(I.rows(), I.cols());
  return difference.dot((identity + I * covariance).partialPivLu().solve(u));
}

}  // namespace aims
