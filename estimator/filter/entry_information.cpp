// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/filter/entry_information.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>

namespace aims {
namespace {

/// Directions in which the data hold less than this part of the known information are not tested.
constexpr double kNotDetermined = 1e-6;

}  // namespace

EntryVector entries_of(const NominalState& state, int offset, int size) {
  return boxminus(state, NominalState()).segment(offset, size);
}

EntryInformation::EntryInformation(int offset, int size)
    : offset_(offset), matrix_(EntryMatrix::Zero(size, size)), vector_(EntryVector::Zero(size)) {}

void EntryInformation::add(const Belief& before, const Belief& after) {
  const auto size = static_cast<int>(vector_.size());
  const auto information = [&](const Belief& belief) -> EntryMatrix {
    return belief.covariance.block(offset_, offset_, size, size).inverse();
  };
  const EntryMatrix less = information(before);
  const EntryMatrix more = information(after);
  const EntryMatrix gained = more - less;
  const EntryVector vector = more * entries_of(after.state, offset_, size) -
                             less * entries_of(before.state, offset_, size);
  if (!gained.allFinite() || !vector.allFinite()) return;
  matrix_ += 0.5 * (gained + gained.transpose());
  vector_ += vector;
}

double disagreement(const EntryInformation& data, const EntryVector& mean,
                    const EntryMatrix& covariance) {
  const EntryMatrix& I = data.matrix();
  const EntryVector u = data.vector() - I * mean;
  const EntryMatrix known = covariance.inverse();
  const EntryVector difference = (I + kNotDetermined * known).ldlt().solve(u);
  const EntryMatrix identity = EntryMatrix::Identity(I.rows(), I.cols());
  return difference.dot((identity + I * covariance).partialPivLu().solve(u));
}

}  // namespace aims
