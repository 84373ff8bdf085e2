// SPDX-License-Identifier: BSD-3-Clause
#include "sim/sensors/return_model.hpp"

#include <algorithm>
#include <cmath>

namespace aims {
namespace {

constexpr double kReferenceReflectivity = 0.1;
/// Received power over the threshold beyond which a return is certain, and below the inverse of
/// which there is none.
constexpr double kCertainPower = 8.0;
/// Of the incidence beyond which its range offset no longer grows: 87 degrees. The measurements
/// behind the formula end there.
constexpr float kLeastCosine = 0.05F;
constexpr float kNormalReflectance = 0.04F;  ///< of a smooth dielectric with index 1.5

double power_over_threshold(double range_at_10_percent, double strength, double range) {
  const double ratio = range_at_10_percent / range;
  return strength / kReferenceReflectivity * ratio * ratio;
}

}  // namespace

double detection_probability(const LidarConfig& config, double reflectivity, double cos_incidence,
                             double range) {
  return detection_probability(config, power_over_threshold(config.range_at_10_percent,
                                                            reflectivity * cos_incidence, range));
}

double detection_probability(const LidarConfig& config, double power) {
  if (power >= kCertainPower) return 1.0;
  if (power * kCertainPower <= 1.0) return 0.0;
  return 1.0 / (1.0 + std::pow(power, -config.detection_steepness));
}

ReturnModel::ReturnModel(const LidarConfig& config, const LidarCalibration& calibration)
    : calibration_(calibration),
      range_at_10_percent_(config.range_at_10_percent),
      specular_loss_(static_cast<float>(config.specular_loss)),
      floor_variance_(static_cast<float>(config.range_sigma * config.range_sigma)),
      noise_factor_(
          static_cast<float>(kReferenceReflectivity * std::pow(config.range_sigma_at_threshold, 2) /
                             std::pow(config.range_at_10_percent, 2))),
      white_noise_limit_(6.0 * config.range_sigma +
                         6.0 * std::sqrt(kCertainPower) * config.range_sigma_at_threshold),
      noise_differs_(config.range_sigma_at_threshold > 0.0),
      has_bias_(calibration.range_bias != 0.0 || calibration.incidence_bias != 0.0 ||
                std::ranges::any_of(calibration.ring_range, [](double b) { return b != 0.0; })) {}

void ReturnModel::strengths(const LaneValues& reflectivity, const LaneValues& cosine,
                            LaneValues& strength) const {
  for (int i = 0; i < kRayPacketSize; ++i) {
    strength[i] = std::clamp(reflectivity[i] * cosine[i], 0.0F, 1.0F);
  }
  if (specular_loss_ == 0.0F) return;
  for (int i = 0; i < kRayPacketSize; ++i) {
    const float flat = 1.0F - cosine[i];
    const float mirrored =
        kNormalReflectance + (1.0F - kNormalReflectance) * flat * flat * flat * flat * flat;
    const float kept = 1.0F - specular_loss_ * mirrored;
    strength[i] *= kept * kept;
  }
}

void ReturnModel::powers(const LaneValues& strength, const RayPacket::Lanes& range,
                         std::array<double, kRayPacketSize>& power) const {
  for (int i = 0; i < kRayPacketSize; ++i) {
    power[i] = power_over_threshold(range_at_10_percent_, strength[i], range[i]);
  }
}

void ReturnModel::range_sigmas(const LaneValues& strength, const RayPacket::Lanes& range,
                               LaneValues& sigma) const {
  for (int i = 0; i < kRayPacketSize; ++i) {
    sigma[i] = std::sqrt(floor_variance_ + noise_factor_ * range[i] * range[i] / strength[i]);
  }
}

void ReturnModel::range_biases(int ring, const LaneValues& cosine, LaneValues& bias) const {
  const auto constant = static_cast<float>(calibration_.range_bias +
                                           calibration_.ring_range[static_cast<std::size_t>(ring)]);
  const auto factor = static_cast<float>(calibration_.incidence_bias);
  for (int i = 0; i < kRayPacketSize; ++i) {
    bias[i] = constant + factor * (1.0F / std::max(cosine[i], kLeastCosine) - 1.0F);
  }
}

double ReturnModel::largest_range_error() const {
  double ring = 0.0;
  for (const double each : calibration_.ring_range) ring = std::max(ring, std::abs(each));
  return white_noise_limit_ + std::abs(calibration_.range_bias) + ring +
         std::abs(calibration_.incidence_bias) * (1.0 / kLeastCosine - 1.0);
}

}  // namespace aims
