// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/config.hpp"

namespace aims {

/// Removal of the information that noisy normals give by chance, and the weights along the axes
/// that remain.
struct SpuriousConfig {
  bool enabled = true;
  double significant = 2.0;  ///< ratio to chance at which information is as likely real as not [-]
  double spread = 0.25;      ///< of the logarithm of what chance gives [-]
};

/// Slow states of the leg odometry.
struct LegStatesConfig {
  bool scale = true;         ///< estimate a scale per axis
  bool bias = true;          ///< estimate a bias per axis
  bool hold = true;          ///< learn them only where the LiDAR is trusted (Schmidt update)
  double scale_sigma = 0.1;  ///< at the start [-]
  double scale_walk = 1e-3;  ///< [1/sqrt(s)]
  double bias_sigma = 0.01;  ///< at the start [m/s]
  double bias_walk = 1e-4;   ///< [m/s/sqrt(s)]
  double trusted = 0.3;      ///< smoothed weight of the weakest axis above which the LiDAR is [-]
};

/// Leg noise from its own evidence.
struct LegEvidenceConfig {
  bool enabled = true;
};

/// Lasting disagreement of LiDAR and legs along an axis.
struct DisagreementConfig {
  bool enabled = true;
};

/// Standing still.
struct StandstillConfig {
  bool enabled = true;
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
};

/// What `aims_d` adds to the family, each part with its own switch.
struct DirectionalConfig {
  SpuriousConfig spurious;
  LegStatesConfig leg_states;
  LegEvidenceConfig leg_evidence;
  DisagreementConfig disagreement;
  StandstillConfig standstill;
  FloorConfig floor;
  RobustConfig robust;
};

void describe(Fields& fields, SpuriousConfig& config);
void describe(Fields& fields, LegStatesConfig& config);
void describe(Fields& fields, LegEvidenceConfig& config);
void describe(Fields& fields, DisagreementConfig& config);
void describe(Fields& fields, StandstillConfig& config);
void describe(Fields& fields, FloorConfig& config);
void describe(Fields& fields, RobustConfig& config);
void describe(Fields& fields, DirectionalConfig& config);

}  // namespace aims
