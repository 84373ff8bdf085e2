// SPDX-License-Identifier: BSD-3-Clause
#include "lab/fidelity/fidelity.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <variant>

#include "bench/metrics/segments.hpp"
#include "lab/fidelity/allan_deviation.hpp"
#include "sim/environment/ray_caster.hpp"
#include "sim/simulation.hpp"

namespace aims {
namespace {

constexpr int kScansPerTaken = 5;               ///< one in so many scans is held against the scene
constexpr double kShortestSegment = 1.0;        ///< [m]
constexpr Duration kEdge = 20 * kMillisecond;   ///< of the leg odometry about a segment's end
constexpr Duration kRunUp = 2 * kSecond;        ///< from setting off until the trot is steady
constexpr Duration kTrotLength = 16 * kSecond;  ///< as the real robot's recording
constexpr Duration kSettling = 500 * kMillisecond;  ///< before the standing robot is looked at

/// What a simulated walk leaves for the study.
struct Walk {
  Truth truth;
  Pose T_body_base;
  std::vector<ImuSample> imu;  ///< at `kImuStatisticsRate`
  std::vector<LidarScanPtr> scans;
  Trajectory leg_odometry;  ///< of the body, in the odometry's frame
  std::vector<LegOdometrySample> legs;
};

void take(const std::vector<Delivery>& deliveries, std::size_t& scans_seen, Walk& walk) {
  for (const Delivery& delivery : deliveries) {
    if (const auto* scan = std::get_if<LidarScanPtr>(&delivery.measurement)) {
      if (scans_seen++ % kScansPerTaken == 0) walk.scans.push_back(*scan);
    } else if (const auto* legs = std::get_if<LegOdometrySample>(&delivery.measurement)) {
      walk.leg_odometry.push_back({legs->stamp, legs->T_odom_base * walk.T_body_base.inverse()});
      walk.legs.push_back(*legs);
    }
  }
}

/// The study's seed, and where it reports what it does.
struct Task {
  std::uint64_t seed = 1;
  const FidelityObserver& observer;
};

Result<Walk> simulated(const SimulationConfig& config, const Task& task, std::string_view step) {
  auto simulation = Simulation::create(config, task.seed);
  if (!simulation) return tl::unexpected(simulation.error());
  Walk walk;
  walk.T_body_base = simulation->rig().T_body_base;
  std::size_t scans_seen = 0;
  for (bool more = true; more;) {
    if (!task.observer(step)) return failure("the study was stopped");
    std::vector<Delivery> deliveries;
    more = simulation->advance(kSecond, deliveries);
    take(deliveries, scans_seen, walk);
    const auto imu = simulation->take_fast_imu();
    walk.imu.insert(walk.imu.end(), imu.begin(), imu.end());
  }
  walk.truth = simulation->truth();
  return walk;
}

/// The scenario's simulation with sensors on perfect links and the IMU sampled at an instant.
SimulationConfig with_fast_imu(const Scenario& scenario) {
  SimulationConfig config = scenario.simulation;
  config.links = {};
  config.links.leg_odometry.loss = 0.0;
  config.imu.sampling = ImuSampling::kPoint;
  config.fast_imu_rate = kImuStatisticsRate;
  return config;
}

/// The same without a LiDAR worth its time.
SimulationConfig without_lidar(SimulationConfig config) {
  const double rate = config.lidar.rate;
  config.lidar = {};
  config.lidar.rate = rate;
  config.lidar.rings = 1;
  config.lidar.columns = 16;
  return config;
}

std::vector<ImuSample> between(const std::vector<ImuSample>& samples, Time begin, Time end) {
  std::vector<ImuSample> part;
  std::ranges::copy_if(samples, std::back_inserter(part), [&](const ImuSample& each) {
    return each.stamp > begin && each.stamp <= end;
  });
  return part;
}

/// Fills in the statistics of the trot after setting off, and of the standing before it.
Result<void> add_imu(const Walk& walk, Fidelity& fidelity) {
  const auto& times = walk.truth.waypoint_times;
  if (times.size() < 2) return failure("the walk ended before its second waypoint");
  const Time begin = times[0].stamp + kRunUp;
  const auto trot = trot_statistics(
      between(walk.imu, begin, std::min(begin + kTrotLength, times[1].stamp - kSecond)));
  const auto standing = standing_statistics(between(walk.imu, kSettling, times[0].stamp));
  if (!trot) return failure("route: expected at least 8 s of trot before the second waypoint");
  if (!standing) return failure("route.stand_before: expected at least 3 s");
  fidelity.trot = *trot;
  fidelity.standing = *standing;
  return {};
}

std::vector<StandingDeviation> standing_deviation(const std::vector<ImuSample>& samples) {
  constexpr double kTimes[] = {0.0025, 0.005, 0.01, 0.02, 0.05, 0.1,  0.2,  0.5,
                               1.0,    2.0,   5.0,  10.0, 20.0, 50.0, 100.0};
  std::vector<StandingDeviation> result;
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<double> gyro, force;
    for (const ImuSample& each : samples) {
      gyro.push_back(each.angular_velocity[axis]);
      force.push_back(each.specific_force[axis]);
    }
    const auto of_gyro = allan_deviation(gyro, kImuStatisticsRate, kTimes);
    const auto of_force = allan_deviation(force, kImuStatisticsRate, kTimes);
    result.resize(of_gyro.size());
    for (std::size_t i = 0; i < of_gyro.size(); ++i) {
      result[i].tau = of_gyro[i].tau;
      result[i].gyro += of_gyro[i].deviation * of_gyro[i].deviation / 3.0;
      result[i].accelerometer += of_force[i].deviation * of_force[i].deviation / 3.0;
    }
  }
  for (StandingDeviation& each : result) {
    each.gyro = std::sqrt(each.gyro);
    each.accelerometer = std::sqrt(each.accelerometer);
  }
  return result;
}

/// Fills in the Allan deviation of a robot that stands for `standing_time` [s].
Result<void> add_allan(const SimulationConfig& fast, const Task& task, double standing_time,
                       Fidelity& fidelity) {
  SimulationConfig config = without_lidar(fast);
  config.route.stand_before = standing_time + 1.0;
  config.max_duration = standing_time;
  const auto standing = simulated(config, task, "Allan deviation of the standing robot");
  if (!standing) return tl::unexpected(standing.error());
  if (standing->truth.walk.end == WalkEnd::kFell) return failure("the robot fell while it stood");
  fidelity.allan =
      standing_deviation(between(standing->imu, kSettling, from_seconds(standing_time)));
  return {};
}

Trajectory lidar_trajectory(const Truth& truth) {
  Trajectory poses = body_trajectory(truth);
  for (StampedPose& each : poses) each.pose = each.pose * truth.mounts.T_body_lidar;
  return poses;
}

std::vector<RangeResidual> residuals_of(const Walk& walk, const RayCaster& caster) {
  const Trajectory T_world_lidar = lidar_trajectory(walk.truth);
  std::vector<RangeResidual> residuals;
  for (const LidarScanPtr& scan : walk.scans) {
    const auto of_scan = range_residuals(*scan, T_world_lidar, caster);
    residuals.insert(residuals.end(), of_scan.begin(), of_scan.end());
  }
  return residuals;
}

/// Error of the odometry's heading at that time [deg].
double heading_error(const Walk& walk, const Trajectory& truth, Time stamp) {
  const auto read = pose_at(walk.leg_odometry, stamp);
  const auto real = pose_at(truth, stamp);
  if (!read || !real) return std::nan("");
  const double error = yaw_of(read->rotation) - yaw_of(real->rotation);
  return std::remainder(error, 2.0 * std::numbers::pi) * 180.0 / std::numbers::pi;
}

/// Appends what the walk's leg odometry reads on each segment.
void add_segments(const Walk& walk, const LegOdometryConfig& config,
                  std::vector<LegDrift>& drifts) {
  const Trajectory truth = body_trajectory(walk.truth);
  const auto segments = segments_of(walk.truth.waypoint_times);
  for (const SegmentDistance& each : segment_distances(
           walk.leg_odometry, truth, segments, kShortestSegment, {.edge = kEdge, .gap = kSecond})) {
    if (!each.signed_percent) continue;
    const double heading = std::remainder(heading_error(walk, truth, each.segment.end) -
                                              heading_error(walk, truth, each.segment.begin),
                                          360.0);
    drifts.push_back(
        {config.foot_model, config.contact_on, each.segment.name, *each.signed_percent, heading});
  }
}

/// Fills in the drift for both foot models, at the configured contact threshold and at three times
/// that.
Result<void> add_legs(const SimulationConfig& fast, const Task& task, Fidelity& fidelity) {
  for (const FootModel model : {FootModel::kPoint, FootModel::kRolling}) {
    for (const double threshold : {1.0, 3.0}) {
      SimulationConfig config = without_lidar(fast);
      config.leg_odometry.foot_model = model;
      config.leg_odometry.contact_on *= threshold;
      config.leg_odometry.contact_off *= threshold;
      const auto walk = simulated(config, task, "leg drift");
      if (!walk) return tl::unexpected(walk.error());
      add_segments(*walk, config.leg_odometry, fidelity.legs);
    }
  }
  return {};
}

}  // namespace

Result<std::vector<StanceBin>> stance_study(const Scenario& walk_of_go1, std::uint64_t seed,
                                            const FidelityObserver& observer) {
  SimulationConfig config = without_lidar(with_fast_imu(walk_of_go1));
  config.leg_odometry.rate = kStanceProfileRate;
  auto walk = simulated(config, {seed, observer}, "stance profile");
  if (!walk) return tl::unexpected(walk.error());
  if (walk->truth.walk.end == WalkEnd::kFell) return failure("the robot fell on its walk");
  const auto& times = walk->truth.waypoint_times;
  if (times.size() < 2) return failure("the walk ended before its second waypoint");
  std::erase_if(walk->legs, [&](const LegOdometrySample& each) {
    return each.stamp < times[0].stamp + kRunUp || each.stamp > times[1].stamp - kSecond;
  });
  const auto profile = stance_profile(foot_readings(walk->truth, walk->legs, config.robot.legs));
  if (!profile) return failure("route: expected two strides of trot before the second waypoint");
  return *profile;
}

Result<Fidelity> fidelity_study(const Scenario& scenario, const Scenario& walk_of_go1,
                                std::uint64_t seed, double standing_time,
                                const FidelityObserver& observer) {
  Fidelity fidelity;
  fidelity.scenario = scenario.name;
  fidelity.seed = seed;
  const SimulationConfig config = with_fast_imu(scenario);
  const Task task{seed, observer};
  const auto walk = simulated(config, task, "walk with all sensors");
  if (!walk) return tl::unexpected(walk.error());
  if (walk->truth.walk.end == WalkEnd::kFell) return failure("the robot fell on its walk");
  if (auto ok = add_imu(*walk, fidelity); !ok) return tl::unexpected(ok.error());
  fidelity.ranges = residual_bins(residuals_of(*walk, RayCaster(build_scene(config.scene, seed))));
  if (auto ok = add_legs(config, task, fidelity); !ok) return tl::unexpected(ok.error());
  auto stance = stance_study(walk_of_go1, seed, observer);
  if (!stance) return tl::unexpected(stance.error());
  fidelity.stance = std::move(*stance);
  if (auto ok = add_allan(config, task, standing_time, fidelity); !ok) {
    return tl::unexpected(ok.error());
  }
  return fidelity;
}

}  // namespace aims
