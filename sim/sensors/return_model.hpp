// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "sim/environment/ray_caster.hpp"
#include "sim/sensors/lidar_calibration.hpp"
#include "sim/sensors/lidar_config.hpp"

namespace aims {

/// Probability that a return of a surface is detected: the received power
/// reflectivity * cos(incidence) / range^2 against the threshold of the configuration.
double detection_probability(const LidarConfig& config, double reflectivity, double cos_incidence,
                             double range);

/// The same of a received power over the threshold.
double detection_probability(const LidarConfig& config, double power);

/// Sixteen values of one packet.
struct alignas(64) LaneValues {
  RayPacket::Lanes values{};

  float& operator[](int lane) { return values[static_cast<std::size_t>(lane)]; }
  float operator[](int lane) const { return values[static_cast<std::size_t>(lane)]; }
};

/// What the LiDAR makes of a return: noise and offset of its range, and its intensity. The strength
/// of a return is what a perpendicular matt target of that reflectivity would give.
class ReturnModel {
 public:
  ReturnModel(const LidarConfig& config, const LidarCalibration& calibration);

  /// Whether the range noise differs between returns.
  bool noise_differs() const { return noise_differs_; }
  /// Whether ranges have offsets.
  bool has_bias() const { return has_bias_; }

  /// reflectivity * cos(incidence), less the mirrored light:
  /// (1 - s F)^2 with F = 0.04 + 0.96 (1 - cos(incidence))^5 and s the specular loss.
  void strengths(const LaneValues& reflectivity, const LaneValues& cosine,
                 LaneValues& strength) const;

  /// Received power over the threshold of detection.
  void powers(const LaneValues& strength, const RayPacket::Lanes& range,
              std::array<double, kRayPacketSize>& power) const;

  /// Standard deviation of the white range noise [m]: sigma^2 = floor^2 + threshold^2 / power,
  /// where the power is 1 at the threshold of detection.
  void range_sigmas(const LaneValues& strength, const RayPacket::Lanes& range,
                    LaneValues& sigma) const;

  /// Offset of the range [m]: constant, by ring, and by incidence (up to 87 degrees).
  void range_biases(int ring, const LaneValues& cosine, LaneValues& bias) const;

  /// Greatest range noise and offset that a detected return may have [m].
  double largest_range_error() const;

 private:
  LidarCalibration calibration_;
  double range_at_10_percent_;  ///< where a perpendicular surface of 10 % is at the threshold [m]
  float specular_loss_;
  float floor_variance_;
  float noise_factor_;        ///< variance = floor + factor range^2 / strength
  double white_noise_limit_;  ///< six sigma of the noisiest detected return [m]
  bool noise_differs_;
  bool has_bias_;
};

}  // namespace aims
