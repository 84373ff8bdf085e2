// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "core/error.hpp"
#include "core/measurements.hpp"
#include "sim/environment/scene.hpp"
#include "sim/robot/truth.hpp"
#include "sim/simulation_config.hpp"

namespace aims {

/// Error that `Simulation::create` finds without physics: the configuration is not valid, or a
/// point or way of the route lies inside a solid or outside the building.
Result<void> check_walk(const SimulationConfig& config, std::uint64_t seed);

/// Wall time [s] spent in the parts of the simulation so far.
struct SimulationTimes {
  double physics = 0.0;  ///< dynamics and gait controller
  double lidar = 0.0;    ///< ray casting and the return model
};

/// One robot on one route through one scene, and the measurements of its sensors.
/// Same configuration and seed: the same deliveries and truth, bit for bit.
class Simulation {
 public:
  /// Error when the robot would start inside a solid, or the route has no length. With two threads
  /// scans are cast while the robot walks on; the output does not depend on it.
  static Result<Simulation> create(const SimulationConfig& config, std::uint64_t seed,
                                   int threads = 1);
  Simulation(Simulation&&) noexcept;
  Simulation& operator=(Simulation&&) noexcept;
  ~Simulation();

  /// Simulates `span` further and appends the deliveries that arrived, in order of arrival.
  /// False once the walk has ended; `truth().walk.end` says how.
  bool advance(Duration span, std::vector<Delivery>& deliveries);

  /// Returns the samples of the second IMU output (`fast_imu_rate`) since the last call: the same
  /// sensor errors with independent noise, without packet loss.
  std::vector<ImuSample> take_fast_imu();

  Time now() const;
  /// Length of the route over its nominal speed plus its pauses: for progress displays.
  Duration expected_duration() const;
  const SensorRig& rig() const;
  const Scene& scene() const;
  const Truth& truth() const;
  const SimulationTimes& times() const;

 private:
  struct Impl;
  explicit Simulation(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

/// What the estimators are told of the robot: no drawn error is part of it.
SensorRig nominal_rig(const SimulationConfig& config);

}  // namespace aims
