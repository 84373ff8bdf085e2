// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>

#include "estimator/filter/kalman_update.hpp"

namespace aims {

/// Of up to six entries of the error state; they need no memory of their own.
using EntryMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 6, 6>;
using EntryVector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 6, 1>;

/// 99.99 % points of the chi-square distribution with 1 to 6 degrees of freedom.
inline constexpr std::array kChiSquare9999 = {15.1, 18.4, 21.1, 23.5, 25.7, 27.9};

/// What measurements say about consecutive entries of the error state that are constant, without
/// the filter's prior and random walk: the sum of what each update adds to information matrix and
/// vector of these entries, P+^-1 - P-^-1 and P+^-1 x+ - P-^-1 x-. All else is marginalized.
class EntryInformation {
 public:
  /// The `size` entries from `offset` on.
  EntryInformation(int offset, int size);

  /// Adds an update that made `after` of `before`.
  void add(const Belief& before, const Belief& after);

  const EntryMatrix& matrix() const { return matrix_; }
  const EntryVector& vector() const { return vector_; }

 private:
  int offset_;
  EntryMatrix matrix_;
  EntryVector vector_;
};

/// The same entries of a state: those of the error from the zero state.
EntryVector entries_of(const NominalState& state, int offset, int size);

/// By how much `data` contradict `known` values: the chi-square statistic of their difference,
/// with as many degrees of freedom as entries that the data determine. `known` is given by its
/// mean and covariance.
double disagreement(const EntryInformation& data, const EntryVector& mean,
                    const EntryMatrix& covariance);

}  // namespace aims
