// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/aims/constrained_lio.hpp"

#include <memory>

#include "estimator/aims/presets.hpp"

namespace aims {

XIcpLioConfig x_icp_published() {
  XIcpLioConfig config{.lio = eskf_preset("lio"), .x_icp = {}};
  config.lio.lidar.selection_voxel = 0.1;
  config.lio.lidar.max_points = 10000;
  return config;
}

XIcpLioConfig x_icp_in_corridor() {
  XIcpLioConfig config = x_icp_published();
  config.x_icp.high_information = 100.0;
  config.x_icp.enough_information = 100.0;
  config.x_icp.insufficient_information = 20.0;
  return config;
}

DcRegLioConfig dcreg_on_lio() { return {.lio = eskf_preset("lio"), .dcreg = {}}; }

void describe(Fields& f, XIcpLioConfig& c) {
  describe(f, c.lio);
  f.group("x_icp", c.x_icp);
  f.idle_if(!c.lio.lidar.enabled, "lidar.enabled is false", {"x_icp"});
}

void describe(Fields& f, DcRegLioConfig& c) {
  describe(f, c.lio);
  f.group("dcreg", c.dcreg);
  f.idle_if(!c.lio.lidar.enabled, "lidar.enabled is false", {"dcreg"});
}

Requirements requirements_of(const XIcpLioConfig& config) { return requirements_of(config.lio); }

Requirements requirements_of(const DcRegLioConfig& config) { return requirements_of(config.lio); }

Result<void> check(const XIcpLioConfig& config) { return check(config.lio); }

Result<void> check(const DcRegLioConfig& config) { return check(config.lio); }

ConstrainedLio::ConstrainedLio(const XIcpLioConfig& config, const SensorRig& rig)
    : EskfEstimator(config.lio, rig, std::make_unique<XIcp>(config.x_icp)) {}

ConstrainedLio::ConstrainedLio(const DcRegLioConfig& config, const SensorRig& rig)
    : EskfEstimator(config.lio, rig, std::make_unique<DcReg>(config.dcreg)) {}

}  // namespace aims
