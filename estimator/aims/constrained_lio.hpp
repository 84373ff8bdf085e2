// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "estimator/aims/eskf_estimator.hpp"
#include "estimator/constrained/dcreg.hpp"
#include "estimator/constrained/x_icp.hpp"

namespace aims {

/// `lio` with X-ICP's update.
struct XIcpLioConfig {
  EskfConfig lio;
  XIcpConfig x_icp;
};

/// `lio` with DCReg's update.
struct DcRegLioConfig {
  EskfConfig lio;
  DcRegConfig dcreg;
};

/// `lio` with a return per 10 cm instead of 25 cm, since X-ICP counts correspondences.
XIcpLioConfig x_icp_published();
/// The same with fewer correspondences per category: a corridor's doors and end wall have no more.
XIcpLioConfig x_icp_in_corridor();
/// With the settings of `lio`.
DcRegLioConfig dcreg_on_lio();

/// The settings of `lio`, and those of the update in a group of their own.
void describe(Fields& fields, XIcpLioConfig& config);
void describe(Fields& fields, DcRegLioConfig& config);
Requirements requirements_of(const XIcpLioConfig& config);
Requirements requirements_of(const DcRegLioConfig& config);
Result<void> check(const XIcpLioConfig& config);
Result<void> check(const DcRegLioConfig& config);

/// LiDAR and IMU with a constrained update (docs/baselines/constrained.md).
class ConstrainedLio final : public EskfEstimator {
 public:
  ConstrainedLio(const XIcpLioConfig& config, const SensorRig& rig);
  ConstrainedLio(const DcRegLioConfig& config, const SensorRig& rig);
};

}  // namespace aims
