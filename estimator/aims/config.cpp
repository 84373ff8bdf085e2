// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/aims/config.hpp"

namespace aims {
namespace {

void state_dependencies(Fields& f, const EskfConfig& c) {
  f.idle_if(!c.lidar.enabled, "lidar.enabled is false",
            {"ground_constraint", "calibration", "robust_kernel", "map", "map_covariance",
             "degeneracy", "cross_validation"});
  f.idle_if(!c.legs.enabled, "legs.enabled is false",
            {"feet", "leg_states", "zero_velocity", "degeneracy.gamma_min",
             "cross_validation.measure_legs"});
}

}  // namespace

void describe(Fields& f, EskfConfig& c) {
  f.group("imu", c.imu);
  f.group("initialization", c.initialization);
  f.group("static_initialization", c.static_initialization);
  f.group("legs", c.legs);
  f.group("feet", c.feet);
  f.group("leg_states", c.leg_states);
  f.group("zero_velocity", c.zero_velocity);
  f.group("ground_constraint", c.ground_constraint);
  f.group("lidar", c.lidar);
  f.group("calibration", c.calibration);
  f.group("robust_kernel", c.robust_kernel);
  f.group("map", c.map);
  f.group("map_covariance", c.map_covariance);
  f.group("degeneracy", c.degeneracy);
  f.group("cross_validation", c.cross_validation);
  f.group("queue", c.queue);
  f.group("prior", c.prior);
  state_dependencies(f, c);
}

Requirements requirements_of(const EskfConfig& config) {
  return {.lidar = config.lidar.enabled, .imu = true, .legs = config.legs.enabled};
}

bool measures_legs(const EskfConfig& config) {
  return config.cross_validation.enabled && config.cross_validation.measure_legs &&
         config.legs.enabled && config.lidar.enabled;
}

Result<void> check(const EskfConfig& config) { return check(config.prior); }

CalibrationConfig estimated_calibration(const EskfConfig& config) {
  CalibrationConfig calibration = config.calibration;
  calibration.enabled = calibration.enabled && config.lidar.enabled;
  if (config.ground_constraint.enabled) calibration.mount_sigma = 0.0;
  return calibration;
}

double sigma_of_fixed_mount(const EskfConfig& config) {
  const bool fixed = config.calibration.enabled && config.ground_constraint.enabled;
  return fixed ? config.calibration.mount_sigma : 0.0;
}

}  // namespace aims
