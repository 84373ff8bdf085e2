// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/lidar/residual_noise.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace aims {
namespace {

/// No map of returns is sharper [m].
constexpr double kLeastSigma = 0.005;
/// Scans over which deviations are averaged.
constexpr double kScans = 20.0;
/// Fewer residuals say nothing about a deviation.
constexpr std::size_t kMinResiduals = 20;
/// Incidences that count as grazing and as facing (66 and 45 deg).
constexpr double kGrazing = 0.4;
constexpr double kFacing = 0.7;

/// Moves `deviation` towards that of a normal variable with these magnitudes.
void average_into(double& deviation, std::vector<double>& magnitudes) {
  if (magnitudes.size() < kMinResiduals) return;
  const auto middle = magnitudes.begin() + static_cast<std::ptrdiff_t>(magnitudes.size() / 2);
  std::nth_element(magnitudes.begin(), middle, magnitudes.end());
  constexpr double kMedianOfNormal = 0.6745;  // median magnitude of a standard normal variable
  deviation += (std::max(*middle / kMedianOfNormal, kLeastSigma) - deviation) / kScans;
}

}  // namespace

double ResidualNoise::sigma(double cosine) const {
  const double range = std::max(0.0, facing_ * facing_ - grazing_ * grazing_);
  return std::sqrt(grazing_ * grazing_ + range * cosine * cosine);
}

void ResidualNoise::learn(const std::vector<IncidentResidual>& residuals) {
  magnitudes_.clear();
  for (const IncidentResidual& each : residuals) {
    if (each.cosine < kGrazing) magnitudes_.push_back(std::abs(each.residual));
  }
  average_into(grazing_, magnitudes_);
  magnitudes_.clear();
  for (const IncidentResidual& each : residuals) {
    if (each.cosine > kFacing) magnitudes_.push_back(std::abs(each.residual));
  }
  average_into(facing_, magnitudes_);
}

}  // namespace aims
