// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/config.hpp"
#include "estimator/baselines/leg_kilo/filter.hpp"
#include "estimator/filter/measurement_queue.hpp"
#include "estimator/interface/estimator_config.hpp"

namespace aims::leg_kilo {

/// The start.
struct Start {
  double variance = 1e-6;  ///< of every entry of the error state, in its unit squared
};

/// Which returns are used.
struct Points {
  int every_nth = 3;        ///< returns, in order of firing
  double min_range = 0.5;   ///< nearer ones are dropped [m]
  double time_step = 2e-3;  ///< firing times are rounded to its multiples [s]
  double voxel = 0.3;       ///< edge; position and time of each are averaged [m]
};

/// Errors of a return, of which the covariance of a point follows.
struct PointNoise {
  double range_sigma = 0.04;    ///< [m]
  double beam_sigma_deg = 0.2;  ///< of the beam's direction, along each axis [deg]
};

/// Variances of what the IMU measures.
struct ImuVariances {
  double force = 0.1;           ///< along x and y [m^2/s^4]
  double vertical_force = 1.0;  ///< along z [m^2/s^4]
  double rate = 0.01;           ///< [rad^2/s^2]
};

/// Which feet stand, and how they move.
enum class FeetFrom {
  kTwist,     ///< four standing feet, whose joints would report the leg odometry's twist
  kContacts,  ///< feet in contact, by their joints; without joints in the stream: as kTwist
};

/// Kinematic observations.
struct Legs {
  bool enabled = true;
  FeetFrom feet = FeetFrom::kTwist;
  double variance = 0.1;      ///< of the velocity of a standing foot, per axis [m^2/s^2]
  double max_age = 0.02;      ///< older leg data belong to no IMU sample [s]
  double force_begin = 20.0;  ///< more begins a contact, where the stream has forces [N]
  double force_end = 10.0;    ///< less ends it [N]
};

/// Association of points with planes, and the weight of a residual.
struct Residuals {
  double gate = 3.0;              ///< deviations of the distance
  double max_extent = 3.0;        ///< of a plane, from its centre, in deviations of its points
  double variance_factor = 10.0;  ///< on the variance of the distance
};

/// The map.
struct Map {
  double voxel = 0.5;            ///< edge [m]
  int layers = 2;                ///< times that a voxel without a plane is divided
  int min_points = 5;            ///< more make a plane
  int refit_points = 5;          ///< more new ones renew a plane
  int max_points = 50;           ///< a plane of more is final
  double max_eigenvalue = 0.01;  ///< of the covariance of a plane's points along the normal [m^2]
};

void describe(Fields& fields, Start& config);
void describe(Fields& fields, Points& config);
void describe(Fields& fields, PointNoise& config);
void describe(Fields& fields, ImuVariances& config);
void describe(Fields& fields, Legs& config);
void describe(Fields& fields, Residuals& config);
void describe(Fields& fields, Map& config);

/// Configuration of Leg-KILO; the defaults are those for a narrow corridor.
struct Config {
  Start start;
  ProcessNoise process_noise;
  Points points;
  PointNoise point_noise;
  ImuVariances imu;
  Legs legs;
  Residuals residuals;
  Map map;
  QueueConfig queue;
};

void describe(Fields& fields, Config& config);

Requirements requirements_of(const Config& config);

/// The published defaults.
Config published();

}  // namespace aims::leg_kilo
