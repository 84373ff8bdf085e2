// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <concepts>
#include <memory>
#include <utility>

#include "core/config.hpp"
#include "core/lidar_rings.hpp"
#include "estimator/interface/estimator.hpp"

namespace aims {

/// What an estimator needs of a stream.
struct Requirements {
  bool lidar = false;
  bool imu = false;
  bool legs = false;            ///< leg odometry
  bool joints = false;          ///< of the legs, and contacts of the feet
  bool rings = false;           ///< of the LiDAR's returns
  bool point_times = false;     ///< of the LiDAR's returns, within the scan
  bool orientation = false;     ///< from the IMU
  LidarRings range_image = {};  ///< rows of its range image; none: it has none, or of any size
};

/// The configuration of one estimator, of whatever type it is, and the way to create it.
class EstimatorConfig {
 public:
  virtual ~EstimatorConfig() = default;
  virtual void describe(Fields& fields) = 0;
  virtual Requirements requirements() const = 0;
  /// Error for values that do not go together, beyond what each parameter allows.
  virtual Result<void> check() const { return {}; }
  virtual std::unique_ptr<Estimator> create(const SensorRig& rig) const = 0;
  virtual std::unique_ptr<EstimatorConfig> clone() const = 0;
};

inline void describe(Fields& fields, EstimatorConfig& config) { config.describe(fields); }

/// The free function `describe` where a member hides it.
template <class Config>
void describe_config(Fields& fields, Config& config) {
  describe(fields, config);
}

/// The free function `check` where a member hides it.
template <class Config>
Result<void> check_config(const Config& config) {
  if constexpr (requires { check(config); }) return check(config);
  return {};
}

/// Configuration `Config` of the estimator `Made`, which is constructed from it and the rig.
/// `describe(Fields&, Config&)` and `requirements_of(const Config&)` belong to it, and
/// `check(const Config&)` where values may not go together.
template <class Config, std::derived_from<Estimator> Made>
class ConfigOf final : public EstimatorConfig {
 public:
  explicit ConfigOf(Config config) : config_(std::move(config)) {}

  void describe(Fields& fields) override { describe_config(fields, config_); }
  Requirements requirements() const override { return requirements_of(config_); }
  Result<void> check() const override { return check_config(config_); }
  std::unique_ptr<Estimator> create(const SensorRig& rig) const override {
    return std::make_unique<Made>(config_, rig);
  }
  std::unique_ptr<EstimatorConfig> clone() const override {
    return std::make_unique<ConfigOf>(config_);
  }

 private:
  Config config_;
};

}  // namespace aims
