// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/aims/config.hpp"

namespace aims {
namespace {

DirectionalConfig without_parts() {
  DirectionalConfig none;
  none.noise_information.enabled = false;
  none.leg_states.scale = false;
  none.leg_states.bias = false;
  none.leg_states.gate_learning = false;
  none.leg_noise.enabled = false;
  none.static_initialization.enabled = false;
  none.zero_velocity.enabled = false;
  none.ground_constraint.enabled = false;
  none.robust_kernel.enabled = false;
  none.map_memory.enabled = true;
  return none;
}

}  // namespace

void describe(Fields& f, DirectionalConfig& c) {
  f.group("noise_information", c.noise_information);
  f.group("leg_states", c.leg_states);
  f.group("leg_noise", c.leg_noise);
  f.group("static_initialization", c.static_initialization);
  f.group("zero_velocity", c.zero_velocity);
  f.group("ground_constraint", c.ground_constraint);
  f.group("robust_kernel", c.robust_kernel);
  f.group("map_memory", c.map_memory);
}

void describe(Fields& f, EstimatorConfig& c) {
  f.group("imu", c.imu);
  f.group("initialization", c.initialization);
  f.group("leg", c.leg);
  f.group("lidar", c.lidar);
  f.group("map", c.map);
  f.group("degeneracy", c.degeneracy);
  f.group("directional", c.directional);
  f.group("queue", c.queue);
}

EstimatorConfig config_for(const EstimatorVariant& variant, EstimatorConfig config) {
  if (!variant.directional) config.directional = without_parts();
  return config;
}

}  // namespace aims
