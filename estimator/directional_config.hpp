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

/// Level floor.
struct FloorConfig {
  bool enabled = true;
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
