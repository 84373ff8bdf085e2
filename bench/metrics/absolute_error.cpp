// SPDX-License-Identifier: BSD-3-Clause
#include "bench/metrics/absolute_error.hpp"

#include <algorithm>
#include <cmath>

#include "bench/metrics/statistics.hpp"

namespace aims {
namespace {

Eigen::Vector3d error_of(const PosePair& pair) {
  return pair.estimate.translation - pair.truth.translation;
}

PosePair moved(const PosePair& pair, const std::optional<Alignment>& alignment) {
  if (!alignment) return pair;
  return {pair.stamp, aligned(pair.estimate, *alignment), pair.truth};
}

}  // namespace

std::optional<double> ate_rmse(std::span<const PosePair> pairs,
                               const std::optional<Alignment>& alignment) {
  if (pairs.empty()) return std::nullopt;
  double sum = 0.0;
  for (const PosePair& each : pairs) sum += error_of(moved(each, alignment)).squaredNorm();
  return std::sqrt(sum / static_cast<double>(pairs.size()));
}

std::vector<double> position_errors(std::span<const PosePair> pairs,
                                    const std::optional<Alignment>& alignment) {
  std::vector<double> errors;
  errors.reserve(pairs.size());
  for (const PosePair& each : pairs) errors.push_back(error_of(moved(each, alignment)).norm());
  return errors;
}

std::optional<AbsoluteErrorStatistics> absolute_error_statistics(
    std::span<const PosePair> pairs, const std::optional<Alignment>& alignment) {
  if (pairs.empty()) return std::nullopt;
  const std::vector<double> errors = position_errors(pairs, alignment);
  AbsoluteErrorStatistics statistics;
  statistics.mean_m = *mean(errors);
  statistics.median_m = *median(errors);
  double squares = 0.0;
  for (const double each : errors) squares += std::pow(each - statistics.mean_m, 2);
  statistics.std_m = std::sqrt(squares / static_cast<double>(errors.size()));
  const auto [least, most] = std::ranges::minmax(errors);
  statistics.min_m = least;
  statistics.max_m = most;
  return statistics;
}

std::optional<double> heading_rmse(std::span<const PosePair> pairs,
                                   const std::optional<Alignment>& alignment) {
  if (pairs.empty()) return std::nullopt;
  double sum = 0.0;
  for (const PosePair& recorded : pairs) {
    const PosePair each = moved(recorded, alignment);
    const double heading = yaw_of(each.estimate.rotation * each.truth.rotation.conjugate());
    sum += heading * heading;
  }
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
