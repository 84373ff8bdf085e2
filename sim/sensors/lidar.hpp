// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "core/config.hpp"
#include "core/error.hpp"
#include "core/measurements.hpp"
#include "core/random.hpp"
#include "core/trajectory.hpp"
#include "sim/environment/ray_caster.hpp"

namespace aims {

/// Parts of a LiDAR that return nothing during the whole run.
struct LidarDefectConfig {
  double dead_ring_fraction = 0.0;         ///< of the rings, drawn per run [-]
  double blocked_sector_center_deg = 0.0;  ///< azimuth, from +x to +y [deg]
  double blocked_sector_width_deg = 0.0;   ///< [deg]; 0: none
};

void describe(Fields& fields, LidarDefectConfig& config);

/// A spinning multi-ring LiDAR.
struct LidarConfig {
  int rings = 16;
  int columns = 1800;                ///< firings of each ring per scan
  double rate = 10.0;                ///< scans per second [Hz]
  double elevation_min_deg = -15.0;  ///< of ring 0 [deg]
  double elevation_max_deg = 15.0;   ///< of the last ring [deg]
  double start_azimuth_deg = 180.0;  ///< of the first firing, +x to +y [deg]; spins clockwise
  double ring_interval_us = 2.304;   ///< between rings of a column, at most what fits [us]
  double range_min = 0.3;            ///< nearer returns are dropped [m]
  double range_max = 100.0;          ///< farther returns are dropped [m]
  double range_sigma = 0.02;         ///< white noise of the range [m]
  double miss_probability = 0.005;   ///< of a return lost at random [-]
  /// Range at which half the returns of a facing target of 10 % reflectivity are detected [m].
  double range_at_10_percent = 50.0;
  double detection_steepness = 6.0;  ///< of the detection probability in the received power [-]
  /// Body mask: a box around trunk, head and hips in the LiDAR frame [m], with a margin; beams that
  /// enter it are dropped. From the mast of `models/quadruped/quadruped.xml`
  /// only the two lowest rings enter it, ahead; thighs and calves stay below all beams. An empty
  /// box masks nothing.
  Eigen::Vector3d body_mask_min = Eigen::Vector3d(-0.10, -0.15, -0.32);
  Eigen::Vector3d body_mask_max = Eigen::Vector3d(0.42, 0.15, -0.085);
  LidarDefectConfig defects;
};

void describe(Fields& fields, LidarConfig& config);

/// Error for limits in the wrong order.
Result<void> validate(const LidarConfig& config);

/// Probability that a return of a surface is detected: the received power
/// reflectivity * cos(incidence) / range^2 against the threshold of the configuration.
double detection_probability(const LidarConfig& config, double reflectivity, double cos_incidence,
                             double range);

/// The true hits of a scan, one entry per point of the scan.
struct ScanTruth {
  std::vector<Eigen::Vector3f> normals;  ///< of the surface, in the world, towards the sensor
  /// Index into `RayCaster::materials`. From `RayCaster::first_moving_surface` on it is a
  /// person, which is no part of the map.
  std::vector<int> surfaces;
  std::vector<Eigen::Vector3f> points;  ///< hit in the world, without noise [m]
  std::vector<float> cosines;           ///< of the angle between beam and normal, in [0, 1]
};

/// Simulates scans in a scene. Same configuration, seed and poses: the same bytes.
class Lidar {
 public:
  /// `caster` must outlive the LiDAR. Random streams: "lidar.noise", "lidar.detection",
  /// "lidar.defects".
  Lidar(const LidarConfig& config, const RayCaster& caster, std::uint64_t run_seed);

  /// Nominal length of one scan.
  Duration period() const;

  /// The scan that starts at `start`; each firing leaves from the pose at its own time.
  /// `T_world_lidar` should cover the scan; beyond its ends the first or last pose holds.
  LidarScan scan(Time start, const Trajectory& T_world_lidar, ScanTruth* truth = nullptr);

 private:
  /// Sixteen neighbouring firings of one ring.
  struct alignas(64) Beams {
    RayPacket::Lanes x, y, z;                                 ///< directions in the LiDAR frame
    std::array<std::int32_t, kRayPacketSize> time_offset_ns;  ///< after the scan's start
    std::array<bool, kRayPacketSize> open;  ///< not blocked, dead or in the body mask
  };
  /// One ring's firings of a block of columns and their hits.
  struct Returns {
    RayPacket rays;
    HitPacket hits;
    RayPacket::Lanes strength;  ///< reflectivity * cos(incidence) [-]
  };

  void aim(int block, const std::vector<Pose>& column_poses);
  void receive(int block, int lanes, Time start);
  void append_points(int block, int lanes, LidarScan& scan, ScanTruth* truth);
  bool detected(float strength, float range);

  LidarConfig config_;
  const RayCaster* caster_;
  RandomStream noise_;
  RandomStream detection_;
  std::vector<float> reflectivity_;  ///< by surface
  std::vector<Beams> beams_;         ///< block by block, ring by ring
  std::vector<Returns> returns_;     ///< of the current block, by ring
};

}  // namespace aims
