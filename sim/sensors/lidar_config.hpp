// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <string>
#include <string_view>
#include <vector>

#include "core/cloud_layout.hpp"
#include "core/config.hpp"
#include "core/error.hpp"

namespace aims {

/// Parts of a LiDAR that return nothing during the whole run.
struct LidarDefectConfig {
  double dead_ring_fraction = 0.0;         ///< of the rings, drawn per run [-]
  double blocked_sector_center_deg = 0.0;  ///< azimuth, from +x to +y [deg]
  double blocked_sector_width_deg = 0.0;   ///< [deg]; 0: none
};

void describe(Fields& fields, LidarDefectConfig& config);

/// Errors that are constant in a run and drawn for it, all with zero mean unless a mean is given.
struct LidarCalibrationConfig {
  double range_bias_sigma = 0.0;  ///< of one offset of every range [m]
  /// Offset of a range by its incidence: c (1 / cos(incidence) - 1) with c drawn [m].
  double incidence_bias_mean = 0.0;
  double incidence_bias_sigma = 0.0;
  double ring_range_sigma = 0.0;          ///< of each ring's offset of its ranges [m]
  double ring_elevation_sigma_deg = 0.0;  ///< of each ring's true elevation [deg]
  /// Of both components of the encoder's error of one period per revolution [deg].
  double azimuth_sigma_deg = 0.0;
};

void describe(Fields& fields, LidarCalibrationConfig& config);

/// The beam's rectangular footprint. All zero: a beam is a line.
struct LidarBeamConfig {
  double divergence_horizontal = 0.0;  ///< full angle [rad]
  double divergence_vertical = 0.0;    ///< full angle [rad]
  double exit_width = 0.0;             ///< at the sensor [m]
  double exit_height = 0.0;            ///< at the sensor [m]
  double pulse_length = 1.0;           ///< surfaces farther apart in range are two echoes [m]

  bool is_line() const {
    return divergence_horizontal == 0.0 && divergence_vertical == 0.0 && exit_width == 0.0 &&
           exit_height == 0.0;
  }
};

void describe(Fields& fields, LidarBeamConfig& config);

/// How the beams of a LiDAR move.
enum class LidarPattern {
  kSpinning,  ///< rings at fixed elevations turn about the vertical axis
  kRosette,   ///< rotating prisms deflect a few beams, and no scan repeats the one before
};

/// The channels of a spinning sensor, one entry each, in the order of its datasheet.
struct LidarTableConfig {
  std::vector<double> elevations_deg;  ///< [deg]; empty: uniform, from the other keys
  /// Of the beam ahead of the housing's azimuth, positive clockwise [deg]; empty: none.
  std::vector<double> azimuth_offsets_deg;
  std::vector<double> firing_delays_us;  ///< after the column's begin [us]; empty: by the rings
};

void describe(Fields& fields, LidarTableConfig& config);

/// Beams deflected by rotating prisms. Deflections add as vectors in the plane whose polar
/// coordinates are the angle from the z axis and the azimuth.
struct LidarRosetteConfig {
  double point_rate = 0.0;                    ///< firings of all beams together [Hz]
  std::vector<double> prism_deflections_deg;  ///< [deg]
  std::vector<double> prism_rates;            ///< positive from +x to +y [Hz]
  std::vector<double> line_offsets_deg;       ///< of each beam from the axis of the prisms [deg]
  double line_azimuth_deg = 0.0;              ///< in which the offsets lie [deg]
};

void describe(Fields& fields, LidarRosetteConfig& config);

/// A LiDAR with one return per firing. The defaults are those of the model `generic`.
struct LidarConfig {
  std::string model = "generic";  ///< of models/lidars; its figures lie below a scenario's own keys
  LidarPattern pattern = LidarPattern::kSpinning;
  CloudLayout layout = CloudLayout::kAims;  ///< of the clouds in a recording
  int rings = 16;
  int columns = 1800;                ///< firings of each ring per scan
  double column_interval_us = 0.0;   ///< fixed time between columns [us]; 0: `columns` a scan
  double rate = 10.0;                ///< scans per second [Hz]
  double elevation_min_deg = -15.0;  ///< of ring 0 [deg]
  double elevation_max_deg = 15.0;   ///< of the last ring [deg]
  double start_azimuth_deg = 180.0;  ///< of the first firing, +x to +y [deg]; spins clockwise
  double ring_interval_us = 2.304;   ///< between rings of a column, at most what fits [us]
  double range_min = 0.3;            ///< nearer returns are dropped [m]
  double range_max = 100.0;          ///< farther returns are dropped [m]
  double range_sigma = 0.02;         ///< white noise of the range [m]
  /// White noise on top at the power of the detection threshold [m]; the variance falls as one over
  /// the received power.
  double range_sigma_at_threshold = 0.0;
  double direction_sigma_deg = 0.0;  ///< white noise of the reported direction, per axis [deg]
  double range_resolution = 0.0;     ///< step of the reported range [m]; 0: continuous
  double miss_probability = 0.005;   ///< of a return lost at random [-]
  /// Range at which half the returns of a facing target of 10 % reflectivity are detected [m].
  double range_at_10_percent = 50.0;
  double detection_steepness = 6.0;  ///< of the detection probability in the received power [-]
  /// Share of the light mirrored away by a smooth surface (Fresnel) that is lost, in [0, 1].
  double specular_loss = 0.0;
  double intensity_sigma = 0.0;       ///< relative white noise of the intensity [-]
  double intensity_resolution = 0.0;  ///< step of the reported intensity [-]; 0: continuous
  /// Body mask: a box around trunk, head and hips in the LiDAR frame [m], with a margin; beams that
  /// enter it are dropped. From the mast of `models/quadruped/quadruped.xml`
  /// only the two lowest rings enter it, ahead; thighs and calves stay below all beams. An empty
  /// box masks nothing.
  Eigen::Vector3d body_mask_min = Eigen::Vector3d(-0.10, -0.15, -0.32);
  Eigen::Vector3d body_mask_max = Eigen::Vector3d(0.42, 0.15, -0.085);
  LidarTableConfig table;
  LidarRosetteConfig rosette;
  LidarBeamConfig beam;
  LidarCalibrationConfig calibration;
  LidarDefectConfig defects;
};

void describe(Fields& fields, LidarConfig& config);

/// Error for limits in the wrong order, and for tables that do not fit together.
Result<void> validate(const LidarConfig& config);

/// Beams that fire one after the other in each column: rings, or the lines of a rosette.
int line_count(const LidarConfig& config);

/// The same sensor with one firing in `factor`.
LidarConfig with_fewer_firings(LidarConfig config, int factor);

/// A file of models/lidars, part of the program.
struct LidarModel {
  std::string_view name;  ///< of the file, without its ending
  std::string_view text;  ///< YAML
};

/// Every LiDAR model; the first is the default.
std::vector<LidarModel> lidar_models();

}  // namespace aims
