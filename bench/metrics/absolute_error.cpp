// SPDX-License-Identifier: BSD-3-Clause
#include "bench/metrics/absolute_error.hpp"

#include <algorithm>
#include <cmath>

namespace aims {
namespace {

Eigen::Vector3d error_of(const PosePair& pair) {
  return pair.estimate.translation - pair.truth.translation;
}

}  // namespace

std::optional<double> ate_rmse(std::span<const PosePair> pairs) {
  if (pairs.empty()) return std::nullopt;
  double sum = 0.0;
  for (const PosePair& each : pairs) sum += error_of(each).squaredNorm();
  return std::sqrt(sum / static_cast<double>(pairs.size()));
}

std::optional<double> max_error(std::span<const PosePair> pairs) {
  if (pairs.empty()) return std::nullopt;
  double largest = 0.0;
  for (const PosePair& each : pairs) largest = std::max(largest, error_of(each).norm());
  return largest;
}

std::optional<double> max_abs_z_error(std::span<const PosePair> pairs) {
  if (pairs.empty()) return std::nullopt;
  double largest = 0.0;
  for (const PosePair& each : pairs) largest = std::max(largest, std::abs(error_of(each).z()));
  return largest;
}

std::optional<EndError> end_error(std::span<const PosePair> pairs) {
  if (pairs.empty()) return std::nullopt;
  const Eigen::Vector3d error = error_of(pairs.back());
  return EndError{error.norm(), error.head<2>().norm(), std::abs(error.z())};
}

}  // namespace aims
