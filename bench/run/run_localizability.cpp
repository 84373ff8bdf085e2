// SPDX-License-Identifier: BSD-3-Clause
#include "bench/run/run_localizability.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "bench/metrics/alignment.hpp"
#include "bench/run/run_map_views.hpp"

namespace aims {
namespace {

/// Spacing at which the bound integrates the motion: a sample of the IMU's default rate.
constexpr Duration kMotionSpacing = 20 * kMillisecond;
constexpr double kStandingFeet = 2.0;  ///< of a trot

TriadErrors triad_errors(const InertialErrorConfig& config) {
  return {config.noise_density, config.bias_walk, config.turn_on_bias};
}

std::vector<TrueMotion> motion_of(const Truth& truth) {
  std::vector<TrueMotion> motion;
  for (const TruthSample& sample : truth.samples) {
    if (!motion.empty() && sample.stamp - motion.back().stamp < kMotionSpacing) continue;
    motion.push_back({sample.stamp, sample.T_world_body, sample.velocity, sample.angular_velocity});
  }
  // The last sample closes the span, so that the last scan has its bound.
  if (!motion.empty() && motion.back().stamp < truth.samples.back().stamp) {
    const TruthSample& last = truth.samples.back();
    motion.push_back({last.stamp, last.T_world_body, last.velocity, last.angular_velocity});
  }
  return motion;
}

std::vector<std::string> localizability_header() {
  std::vector<std::string> header = {
      "stamp_s",     "returns",     "equivalent_returns", "lambda_min",          "crb_sigma_m",
      "weak_axis_x", "weak_axis_y", "weak_axis_z",        "rotation_lambda_min", "crb_sigma_rad"};
  for (const DegeneracyLevel& level : kDegeneracyLevels) {
    header.push_back("degenerate_" + std::string(level.name));
  }
  for (const char* name : {"bound_weak_axis_m", "bound_longitudinal_m", "bound_lateral_m",
                           "bound_vertical_m", "bound_heading_rad", "bound_leg_scale"}) {
    header.emplace_back(name);
  }
  return header;
}

}  // namespace

BoundParameters bound_parameters(const SimulationConfig& config, const SensorRig& rig) {
  BoundParameters parameters;
  parameters.gyro = triad_errors(config.imu.gyro);
  parameters.accelerometer = triad_errors(config.imu.accelerometer);
  const LinkConfig& link = config.links.leg_odometry;
  parameters.legs.packets_per_second =
      config.leg_odometry.rate * (1.0 - link.loss) * (1.0 - link.burst_fraction);
  parameters.legs.velocity_sigma =
      std::max(1e-4, config.leg_odometry.joint_rate_noise * config.robot.gait.body_height /
                         std::sqrt(kStandingFeet));
  parameters.legs.scale_sigma = config.leg_odometry.velocity_scale_error;
  parameters.T_body_base = rig.T_body_base;
  return parameters;
}

RunLocalizability run_localizability(const SimulationConfig& config, const SensorRig& rig,
                                     std::uint64_t seed, const Truth& truth,
                                     const Trajectory& truth_trajectory) {
  RunLocalizability result;
  result.scans = localizability_of(truth.scans, truth_trajectory);
  result.parameters = bound_parameters(config, rig);
  const MapViews map = map_views(config, rig, seed, truth);
  result.bounds = unknown_map_bounds(motion_of(truth), map.scans, map.centres, result.parameters);
  return result;
}

std::vector<PosteriorBound> bounds_without_lidar(const Truth& truth,
                                                 const RunLocalizability& localizability) {
  BoundParameters parameters = localizability.parameters;
  parameters.lidar = false;
  return posterior_bounds(motion_of(truth), truth.scans, parameters);
}

Duration half_scan(const SimulationConfig& config) { return from_seconds(0.5 / config.lidar.rate); }

std::vector<WeakAxisError> weak_axis_errors_of(const EstimatorResult& report,
                                               const Trajectory& truth_trajectory,
                                               const RunLocalizability& localizability,
                                               const ScoreConfig& scoring, Duration tolerance) {
  const std::vector<PosePair> pairs =
      associate(valid_part(report.trajectory), truth_trajectory, scoring.association,
                from_seconds(scoring.association_tolerance));
  std::vector<StatedCovariance> stated;
  for (const ScanRow& scan : report.diagnostics.scans) {
    if (scan.covariance) stated.push_back({scan.stamp, scan.covariance->position});
  }
  return weak_axis_errors(aligned(pairs, align_start(pairs, scoring.anchor)), stated,
                          localizability.scans, localizability.bounds, tolerance);
}

CsvTable localizability_table(const RunLocalizability& localizability) {
  CsvTable table(localizability_header());
  for (std::size_t i = 0; i < localizability.scans.size(); ++i) {
    const Localizability& scan = localizability.scans[i];
    const PosteriorBound& bound = localizability.bounds[i];
    table.add(to_seconds(scan.stamp)).add(scan.returns).add(scan.equivalent_returns);
    table.add(scan.lambda_min).add(scan.sigma);
    const Eigen::Vector3d& axis = scan.weak_axis_in_world;
    table.add(axis.x()).add(axis.y()).add(axis.z());
    table.add(scan.rotation_lambda_min).add(scan.rotation_sigma);
    for (const DegeneracyLevel& level : kDegeneracyLevels) table.add(is_degenerate(scan, level));
    table.add(bound_along(bound, axis))
        .add(bound.longitudinal)
        .add(bound.lateral)
        .add(bound.vertical);
    table.add(bound.heading).add(bound.leg_scale).end_row();
  }
  return table;
}

}  // namespace aims
