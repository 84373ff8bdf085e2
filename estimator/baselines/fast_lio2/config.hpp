// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/config.hpp"
#include "estimator/baselines/fast_lio2/prediction.hpp"
#include "estimator/filter/measurement_queue.hpp"
#include "estimator/interface/estimator_config.hpp"

namespace aims::fast_lio2 {

/// The still start.
struct Start {
  int min_samples = 10;                          ///< IMU samples that are averaged, at least
  double extrinsic_rotation_variance = 1e-5;     ///< [rad^2]
  double extrinsic_translation_variance = 1e-5;  ///< [m^2]
  double gyro_bias_variance = 1e-4;              ///< [rad^2/s^2]
  double accelerometer_bias_variance = 1e-3;     ///< [m^2/s^4]
  double gravity_variance = 1e-5;                ///< [rad^2]
  double pose_variance = 1.0;                    ///< position [m^2] and rotation [rad^2]
  double velocity_variance = 1.0;                ///< [m^2/s^2]
};

/// Which returns are used.
struct Points {
  int every_nth = 3;       ///< returns, in order of firing
  double min_range = 0.5;  ///< nearer ones are dropped [m]
  double voxel = 0.5;      ///< edge; the centroid of each is matched and mapped [m]
};

/// Association of points with planes of the map, and the weight of a residual.
struct Residuals {
  double max_squared_distance = 5.0;  ///< of the fifth neighbour [m^2]
  double plane_threshold = 0.1;       ///< of each neighbour from the plane [m]
  double score_slope = 0.9;           ///< s = 1 - slope |d| / sqrt(range) [1/sqrt(m)]
  double min_score = 0.9;             ///< points with a smaller s are left out [-]
  double variance = 1e-3;             ///< R [m^2]
};

/// The iterated update.
struct Iterations {
  int max = 3;                ///< after the first one
  double convergence = 1e-3;  ///< greatest change of each entry of the error state [m, rad, ...]
  bool estimate_extrinsic = false;  ///< else it is that of the rig
};

/// The map.
struct Map {
  double voxel = 0.5;              ///< edge [m]
  double cube = 1000.0;            ///< edge of the local map [m]
  double detection_range = 100.0;  ///< of the LiDAR [m]
  double moving_factor = 1.5;      ///< the cube moves when a face is nearer than this x range [-]
};

void describe(Fields& fields, Start& config);
void describe(Fields& fields, Points& config);
void describe(Fields& fields, Residuals& config);
void describe(Fields& fields, Iterations& config);
void describe(Fields& fields, Map& config);

/// Configuration of FAST-LIO2; the defaults are those for a narrow corridor.
struct Config {
  Start start;
  ProcessNoise process_noise;
  Points points;
  Residuals residuals;
  Iterations iterations;
  Map map;
  QueueConfig queue;
};

void describe(Fields& fields, Config& config);

Requirements requirements_of(const Config& config);

/// The published defaults for a 16-ring LiDAR.
Config published();

}  // namespace aims::fast_lio2
