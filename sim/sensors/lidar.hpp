// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/measurements.hpp"
#include "core/random.hpp"
#include "core/trajectory.hpp"
#include "sim/environment/ray_caster.hpp"
#include "sim/run_seeds.hpp"
#include "sim/sensors/beam_footprint.hpp"
#include "sim/sensors/lidar_calibration.hpp"
#include "sim/sensors/lidar_config.hpp"
#include "sim/sensors/return_model.hpp"
#include "sim/sensors/scan_pattern.hpp"

namespace aims {

/// Unit directions of sixteen beams in the LiDAR frame.
struct alignas(64) BeamDirections {
  RayPacket::Lanes x, y, z;
};

/// Sixteen neighbouring firings of one ring or line.
struct alignas(64) BeamPacket {
  BeamDirections nominal;                                   ///< as the sensor reports them
  std::array<std::int32_t, kRayPacketSize> time_offset_ns;  ///< after the scan's start
  std::array<bool, kRayPacketSize> open;  ///< not blocked, dead or in the body mask
};

/// The firings of a scan.
struct LidarBeams {
  std::vector<BeamPacket> packets;  ///< block of columns by block, line by line
  /// True directions, as `packets`; empty when they are the nominal ones.
  std::vector<BeamDirections> deviating;

  const BeamDirections& actual(int packet) const {
    const auto i = static_cast<std::size_t>(packet);
    return deviating.empty() ? packets[i].nominal : deviating[i];
  }
};

/// The rings or lines that work; the dead rings of a run are drawn from "lidar.defects".
std::vector<bool> working_lines(const LidarConfig& config, std::uint64_t run_seed);

/// The beams of scan `scan`.
LidarBeams make_beams(const LidarConfig& config, const ScanPattern& pattern,
                      const LidarCalibration& calibration, const std::vector<bool>& works,
                      std::int64_t scan);

/// The true hits of a scan, one entry per point of the scan.
struct ScanTruth {
  std::vector<Eigen::Vector3f> normals;  ///< of the surface, in the world, towards the sensor
  /// Index into `RayCaster::materials`. From `RayCaster::first_moving_surface` on it is a
  /// person, which is no part of the map.
  std::vector<int> surfaces;
  /// Hit in the world, without noise [m]; of a footprint over an edge, the mean of its echo.
  std::vector<Eigen::Vector3f> points;
  std::vector<float> cosines;  ///< of the angle between beam and normal, in [0, 1]
  /// White noise of each range [m], infinite for a footprint over an edge. Empty when every range
  /// has the noise of the configuration.
  std::vector<float> range_sigmas;

  void clear();
};

/// Simulates scans in a scene. Same configuration, seed and poses: the same bytes.
class Lidar {
 public:
  /// `caster` must outlive the LiDAR. Random streams: "lidar.noise", "lidar.detection",
  /// "lidar.intensity", "lidar.direction", "lidar.calibration", "lidar.defects".
  Lidar(const LidarConfig& config, const RayCaster& caster, RunSeeds seeds);

  /// Nominal length of one scan.
  Duration period() const { return scan_period(config_); }

  const ScanPattern& pattern() const { return pattern_; }

  /// The errors drawn for this run; no estimator may see them.
  const LidarCalibration& calibration() const { return calibration_; }

  /// The scan that starts at `start`, the pattern's scan of that time; each firing leaves from the
  /// pose at its own time. `T_world_lidar` should cover the scan; beyond its ends the first or last
  /// pose holds. `truth` is replaced; its memory is used again.
  LidarScan scan(Time start, const Trajectory& T_world_lidar, ScanTruth* truth = nullptr);

 private:
  /// One line's firings of a block of columns and their returns.
  struct Returns {
    RayPacket rays;
    HitPacket hits;
    LaneValues cosine;    ///< of the incidence [-]
    LaneValues strength;  ///< see `ReturnModel` [-]
  };
  /// What the receiver makes of one line's firings of a block.
  struct Received {
    std::array<double, kRayPacketSize> power;  ///< over the threshold of detection [-]
    LaneValues sigma;                          ///< white noise of the range [m]
    LaneValues bias;                           ///< of the range [m]
    LaneValues x, y, z;                        ///< of the true hit in the world [m]
    LaneValues cosine;                         ///< see `ScanTruth::cosines`
  };
  /// A firing of a block.
  struct Place {
    int line;
    int lane;
  };

  void take_beams(std::int64_t index);
  void aim(int block, const std::vector<Pose>& column_poses);
  void receive(int block, Time start);
  void cast(const std::array<Time, kRayPacketSize>& stamps, int count, Returns& each) const;
  void mark_edges(int block);
  void mark_edge(int ring, int column, const Returns& a, int lane_a, const Returns& b, int lane_b);
  void probe_borders(int block, int ring, EdgeMap::Place place, Time start);
  void spread_beams(int block, Time start);
  void resolve_footprint(int block, int ring, int lane, Time start);
  void finish_before(int block, LidarScan& scan, ScanTruth* truth);
  void append_points(int block, const std::vector<Returns>& returns, LidarScan& scan,
                     ScanTruth* truth);
  void receive_block(const std::vector<Returns>& returns);
  void detect(const BeamPacket* beams, int lanes, const std::vector<Returns>& returns);
  void measure_ranges(const std::vector<Returns>& returns);
  void append_measured(const BeamPacket* beams, const std::vector<Returns>& returns,
                       std::vector<LidarPoint>& points);
  void append_hits(const std::vector<Returns>& returns, ScanTruth& truth);
  void append_noise(int block, ScanTruth& truth) const;
  void turn_directions(std::span<LidarPoint> directions);
  int lanes_of(int block) const;

  LidarConfig config_;
  const RayCaster* caster_;
  ScanPattern pattern_;
  LidarCalibration calibration_;
  ReturnModel model_;
  RandomStream noise_;
  RandomStream detection_;
  RandomStream intensity_noise_;
  RandomStream direction_noise_;
  std::vector<float> reflectivity_;  ///< by surface
  std::vector<bool> works_;          ///< by line
  LidarBeams beams_;                 ///< of the present scan
  int columns_;                      ///< of the present scan
  std::vector<Returns> returns_;     ///< of the newest block, by line
  std::vector<Returns> before_;      ///< of the block before, by line; only with footprints
  std::vector<Received> received_;   ///< of the block that is measured, by line
  std::vector<Place> detected_;      ///< of that block, in the order of firing
  std::vector<double> ranges_;       ///< measured, of `detected_` [m]
  std::vector<double> draws_;        ///< of noise, for `detected_` [-]
  BeamFootprint footprint_;
  EdgeMap edges_;
  float reach_;  ///< of the rays [m]
};

}  // namespace aims
