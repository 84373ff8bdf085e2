// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/lidar/row_selection.hpp"

#include <Eigen/Cholesky>
#include <algorithm>

namespace aims {
namespace {

/// Regularisation of A, relative to its diagonal.
constexpr double kRidge = 1e-9;

/// Leverages of the rows: between 0 and 1, six in all.
std::vector<double> leverages(std::span<const Vector6> jacobians) {
  Matrix6 A = Matrix6::Zero();
  for (const Vector6& h : jacobians) A.noalias() += h * h.transpose();
  A.diagonal() += kRidge * A.diagonal() + Vector6::Constant(1e-12);
  const Matrix6 inverse = A.llt().solve(Matrix6::Identity());
  std::vector<double> all;
  all.reserve(jacobians.size());
  for (const Vector6& h : jacobians) all.push_back(h.dot(inverse * h));
  return all;
}

/// The factor with which sum min(1, factor * leverage) is `limit`.
double factor_for(std::span<const double> leverages, double limit) {
  double factor = limit / 6.0;
  for (int i = 0; i < 20; ++i) {
    double sure = 0.0;
    double rest = 0.0;
    for (double each : leverages) {
      if (factor * each >= 1.0) {
        sure += 1.0;
      } else {
        rest += each;
      }
    }
    if (rest <= 0.0 || sure >= limit) break;
    const double next = (limit - sure) / rest;
    if (next <= factor * (1.0 + 1e-6)) break;
    factor = next;
  }
  return factor;
}

}  // namespace

void select_rows(std::span<const Vector6> jacobians, int limit, std::vector<KeptRow>& kept) {
  kept.clear();
  const auto count = static_cast<int>(jacobians.size());
  if (count <= limit) {
    for (int i = 0; i < count; ++i) kept.push_back({i, 1.0});
    return;
  }
  const std::vector<double> all = leverages(jacobians);
  const double factor = factor_for(all, limit);
  double passed = 0.5;  // rows due so far: one is kept whenever it passes a whole number
  for (int i = 0; i < count; ++i) {
    const double share = std::min(factor * all[static_cast<std::size_t>(i)], 1.0);
    passed += share;
    if (passed < 1.0) continue;
    passed -= 1.0;
    kept.push_back({i, 1.0 / share});
  }
}

}  // namespace aims
