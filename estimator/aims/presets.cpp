// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/aims/presets.hpp"

#include <algorithm>
#include <array>
#include <cassert>

namespace aims {
namespace {

/// The parts of `aims_d` that do not judge the directions of a scan.
EskfConfig without_directional_weights() {
  EskfConfig config;
  config.static_initialization.enabled = true;
  config.legs.velocity_sigma.setConstant(0.03);
  config.feet.enabled = true;
  config.leg_states.enabled = true;
  config.zero_velocity.enabled = true;
  config.ground_constraint.enabled = true;
  config.robust_kernel.enabled = true;
  config.map_covariance.enabled = true;
  return config;
}

constexpr std::array kPresets = {
    EskfPreset{"aims", "LiDAR, IMU and legs, weighted by the degeneracy index of the paper",
               [] {
                 EskfConfig config;
                 config.degeneracy.enabled = true;
                 return config;
               }},
    EskfPreset{"aims_d",
               "beyond the paper: real information per axis, leg scale, ground constraint",
               [] {
                 EskfConfig config = without_directional_weights();
                 config.cross_validation.enabled = true;
                 return config;
               }},
    EskfPreset{"tfs", "fixed weights, zero-order hold of lost leg packets: the paper's ablation",
               [] {
                 EskfConfig config;
                 config.legs.repeat_lost = true;
                 return config;
               }},
    EskfPreset{"tfs_clean", "fixed weights, lost leg packets skipped", [] { return EskfConfig(); }},
    EskfPreset{"tfs_plus", "tfs_clean with all parts of aims_d but cross-validation",
               [] { return without_directional_weights(); }},
    EskfPreset{"leg_inertial", "IMU and legs alone, each foot a measurement",
               [] {
                 EskfConfig config = without_directional_weights();
                 config.lidar.enabled = false;
                 return config;
               }},
    EskfPreset{"lio", "LiDAR and IMU only, fixed weights",
               [] {
                 EskfConfig config;
                 config.legs.enabled = false;
                 return config;
               }},
};

}  // namespace

std::span<const EskfPreset> eskf_presets() { return kPresets; }

EskfConfig eskf_preset(std::string_view name) {
  const auto preset = std::ranges::find(kPresets, name, &EskfPreset::name);
  assert(preset != kPresets.end());
  return preset->config();
}

}  // namespace aims
