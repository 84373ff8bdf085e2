// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/config.hpp"
#include "estimator/filter/measurement_queue.hpp"
#include "estimator/interface/estimator_config.hpp"

namespace aims::bievr {

/// Which returns are matched.
struct Points {
  double min_range = 0.5;         ///< nearer ones are dropped [m]
  double max_range = 100.0;       ///< farther ones are dropped [m]
  double voxel = 0.1;             ///< edge; each keeps the return nearest to its centre [m]
  bool informed_sampling = true;  ///< all of these in voxels of much relief, else one a voxel
  int informed_voxels = 300;      ///< voxels of the map whose points are all kept
};

/// The map: an image of heights over a plane in each voxel.
struct MapConfig {
  double pixel = 0.05;            ///< edge [m]
  double voxel = 0.5;             ///< edge [m]
  double normal_tolerance = 3.0;  ///< a normal that turns further gets a new image [deg]
  bool smooth = true;             ///< heights that are matched are averaged with their neighbours
  bool weighted = true;           ///< near points count more
  int max_voxels = 1500000;       ///< those not seen for longest are dropped
};

/// Nonlinear least squares of the heights of the points over the images, Levenberg-Marquardt.
struct RegistrationConfig {
  double huber = 0.1;              ///< residuals beyond count linearly [m]
  int max_iterations = 20;         ///< accepted steps
  int max_attempts = 20;           ///< dampings tried per step
  double rotation_epsilon = 1e-4;  ///< a step below both ends the iteration [-]
  double position_epsilon = 1e-5;  ///< [m]
  double first_damping = 1e-9;     ///< of the largest diagonal entry of the Hessian [-]
  bool relief = true;              ///< false: points to the planes of the voxels
};

/// Velocity, biases and gravity, from the IMU between fixed poses.
struct InertialConfig {
  double start = 0.2;           ///< standing time that gives the first biases [s]
  double window = 10.0;         ///< of the poses [s]
  int min_intervals = 5;        ///< before the first solution
  int min_voxels = 100;         ///< of the map, before a pose counts
  double gravity_weight = 5.0;  ///< of the last direction of gravity [-]
};

void describe(Fields& fields, Points& config);
void describe(Fields& fields, MapConfig& config);
void describe(Fields& fields, RegistrationConfig& config);
void describe(Fields& fields, InertialConfig& config);

/// Configuration of BIEVR-LIO; the defaults are the published ones.
struct Config {
  Points points;
  MapConfig map;
  RegistrationConfig registration;
  InertialConfig inertial;
  QueueConfig queue;
};

void describe(Fields& fields, Config& config);

Requirements requirements_of(const Config& config);

}  // namespace aims::bievr
