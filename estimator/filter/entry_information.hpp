// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "estimator/filter/kalman_update.hpp"

namespace aims {

/// What measurements say about consecutive entries of the error state that are constant, without
/// the filter's prior and random walk: the sum of what each update adds to information matrix and
/// vector of these entries, P+^-1 - P-^-1 and P+^-1 x+ - P-^-1 x-. All else is marginalized.
class EntryInformation {
 public:
  /// The `size` entries from `offset` on.
  EntryInformation(int offset, int size);

  /// Adds an update that made `after` of `before`.
  void add(const Belief& before, const Belief& after);

  const Eigen::MatrixXd& matrix() const { return matrix_; }
  const Eigen::VectorXd& vector() const { return vector_; }

 private:
  int offset_;
  Eigen::MatrixXd matrix_;
  Eigen::VectorXd vector_;
};

/// The same entries of a state: those of the error from the zero state.
Eigen::VectorXd entries_of(const NominalState& state, int offset, int size);

/// By how much `data` contradict `known` values: the chi-square statistic of their difference,
/// with as many degrees of freedom as entries that the data determine. `known` is given by its
/// mean and covariance.
double disagreement(const EntryInformation& data, const Eigen::VectorXd& mean,
                    const Eigen::MatrixXd& covariance);

}  // namespace aims
