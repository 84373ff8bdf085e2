// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "core/config.hpp"

namespace aims {

/// Removal of the information that noisy normals give by chance, and the weights along the axes
/// that remain.
struct SpuriousConfig {
  bool enabled = true;
  /// What is left of plane fits, edges and all, overstates the noise of normals: this share of the
  /// chance information that it implies is found between walls without features.
  double chance_share = 0.7;
  double significant = 1.35;  ///< ratio to chance at which it is as likely real as not [-]
  /// What a robot mapped while it stood is one draw of chance, seen again and again: at the start
  /// this share more is asked for, which falls off over `start_way`.
  double start_excess = 0.3;
  double start_way = 8.0;  ///< [m]
  /// From the start and over this way what is beyond chance is taken for real before it is proven:
  /// the map that it is to be proven by is only as sharp as the poses that draw it [m].
  double trusting_way = 5.0;
  double spread = 0.05;  ///< of the logarithm of what chance gives [-]
  double stretch = 1.5;  ///< way over which information is judged [m]
  /// A step along an axis is lengthened by the inverse of the share of its information that is
  /// beyond chance, and no further than by this: at the start that share lags behind.
  double amplification = 2.5;
  double axis_tolerance = 0.02;  ///< within which the axes are kept [rad]
};

/// Slow states of the leg odometry.
struct LegStatesConfig {
  bool scale = true;          ///< estimate a scale per axis
  bool bias = true;           ///< estimate a bias per axis
  bool hold = true;           ///< learn them only where the LiDAR is trusted (Schmidt update)
  double scale_sigma = 0.12;  ///< at the start [-]
  double scale_walk = 1e-3;   ///< [1/sqrt(s)]
  double bias_sigma = 0.01;   ///< at the start [m/s]
  double bias_walk = 1e-4;    ///< [m/s/sqrt(s)]
  double trusted = 0.3;       ///< weight of the weakest axis above which the LiDAR is [-]
};

/// Leg noise from its own evidence.
struct LegEvidenceConfig {
  bool enabled = true;
  /// Of one sample in a firm stance, base axes [m/s]; the scale is a state of its own.
  Eigen::Vector3d velocity_sigma{0.07, 0.07, 0.07};
  double correlation_time = 0.1;  ///< of that error: consecutive samples repeat it [s]
  double nominal_spread = 0.03;   ///< among the velocities told by feet that stand firm [m/s]
  double one_foot_sigma = 0.05;   ///< added when a single foot stands [m/s]
  double no_foot_sigma = 0.5;     ///< added when no foot stands [m/s]
  double turning_arm = 0.03;      ///< added per rate of yaw [m]
  double gap_growth = 0.1;        ///< added per time without packets [m/s^2]
  double gate = 16.3;             ///< chi-square, 3 dof, 99.9 %: above it the noise grows [-]
  double drop = 100.0;            ///< growth of the variance beyond which a sample is dropped [-]
  double longest_slip = 0.5;      ///< an innovation that lasts longer is believed [s]
};

/// A start that may be shoved.
struct StartConfig {
  bool enabled = true;
  double rate = 0.03;     ///< deviation from the mean of a quiet stretch that ends it [rad/s]
  double force = 0.1;     ///< deviation from the mean of a quiet stretch that ends it [m/s^2]
  double shortest = 0.2;  ///< a shorter stretch tells no tilt [s]
  /// A shorter stretch tells no gyro bias [s]: 5 mrad of sway in 0.3 s are 17 mrad/s.
  double shortest_for_rate = 0.9;
};

/// Standing still.
struct StandstillConfig {
  bool enabled = true;
  double window = 0.3;           ///< IMU and legs rest for so long; one measurement per window [s]
  double rate = 0.03;            ///< largest rate of turn, and deviation from its mean [rad/s]
  double force = 0.3;            ///< largest deviation of the force from its mean [m/s^2]
  double leg_speed = 0.02;       ///< largest speed that the legs report, smoothed [m/s]
  double joint_rate = 0.15;      ///< largest root mean square rate of the joints [rad/s]
  double leg_smoothing = 0.05;   ///< of both, time constant [s]
  double hysteresis = 1.5;       ///< a standing robot may exceed the limits by this factor [-]
  double sigma_velocity = 0.01;  ///< of a body at rest [m/s]
  double sigma_rate = 3e-3;      ///< of the mean rate of a body at rest [rad/s]
};

/// Level floor: what counts as one, and how well it is one.
struct FloorConfig {
  bool enabled = true;
  double radius = 6.0;              ///< it is sought within it, horizontally [m]
  double min_height = 0.15;         ///< of the body above it [m]
  double max_height = 1.2;          ///< of the body above it [m]
  double max_slope = 0.15;          ///< of it in body axes, where points are sought [-]
  double band = 0.04;               ///< points this close to the plane are on it [m]
  int min_points = 60;              ///< on it
  double min_spread = 0.25;         ///< least deviation of its points along any direction [m]
  double max_residual = 0.015;      ///< root mean square of what its points leave [m]
  double bend = 0.02;               ///< a part that lies further off is not level with it [m]
  double tilt = 7.5e-3;             ///< a floor less tilted is level [rad]
  double max_tilt = 1.5e-2;         ///< one more tilted is not, however unsure the attitude [rad]
  double step = 0.05;               ///< change of height that makes it another floor [m]
  double settle = 1.0;              ///< way on level floor before it is believed again [m]
  double spacing = 0.03;            ///< way between measurements [m]
  double correlation_length = 0.7;  ///< over it the unevenness repeats itself [m]
  double sigma_tilt = 1e-3;         ///< unevenness of a level floor, about either axis [rad]
  double sigma_height = 5e-3;       ///< unevenness of a level floor [m]
};

/// Robust weight of each point.
struct RobustConfig {
  bool enabled = true;
  double scale = 3.0;    ///< deviations of the scan's residuals at which a weight is a half [-]
  double least = 0.015;  ///< deviation that is taken at least [m]
};

/// Re-use of the map from earlier in the walk.
struct MapMemoryConfig {
  bool enabled = true;     ///< false: voxels are forgotten when unseen for `forget_after`
  int forget_after = 150;  ///< scans
};

/// What `aims_d` adds to the family, each part with its own switch.
struct DirectionalConfig {
  SpuriousConfig spurious;
  LegStatesConfig leg_states;
  LegEvidenceConfig leg_evidence;
  StartConfig start;
  StandstillConfig standstill;
  FloorConfig floor;
  RobustConfig robust;
  MapMemoryConfig map_memory;
};

/// With none of the parts, as for the other members of the family.
DirectionalConfig without_parts();

void describe(Fields& fields, SpuriousConfig& config);
void describe(Fields& fields, LegStatesConfig& config);
void describe(Fields& fields, LegEvidenceConfig& config);
void describe(Fields& fields, StartConfig& config);
void describe(Fields& fields, StandstillConfig& config);
void describe(Fields& fields, FloorConfig& config);
void describe(Fields& fields, RobustConfig& config);
void describe(Fields& fields, MapMemoryConfig& config);
void describe(Fields& fields, DirectionalConfig& config);

}  // namespace aims
