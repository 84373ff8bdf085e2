// SPDX-License-Identifier: BSD-3-Clause
#include "sim/simulation.hpp"

#include <algorithm>
#include <limits>
#include <optional>
#include <utility>

#include "core/background_tasks.hpp"
#include "core/stopwatch.hpp"
#include "sim/environment/ray_caster.hpp"
#include "sim/environment/scene_mjcf.hpp"
#include "sim/links/link.hpp"
#include "sim/robot/scene_route.hpp"
#include "sim/robot/walk_monitor.hpp"
#include "sim/robot/walker.hpp"
#include "sim/sensors/fisher_information.hpp"

namespace aims {
namespace {

constexpr Duration kSnapshotPeriod = 100 * kMillisecond;

BuildErrors build_errors(const LegOdometryConfig& legs) {
  return {.link_length = legs.link_length_error, .foot_radius = legs.foot_radius_difference};
}

Result<WorldSetup> world_setup(const SimulationConfig& config, const Scene& scene, RunSeeds seeds) {
  const RobotConfig& robot = config.robot;
  const auto model = robot_model(robot.model);
  if (!model) return tl::unexpected(model.error());
  auto mjcf = scene_mjcf(scene, model->mjcf, MjcfPurpose::kPhysics,
                         {.floor_friction = config.scene.floor_friction});
  if (!mjcf) return tl::unexpected(mjcf.error());
  return WorldSetup{std::move(*mjcf),
                    height_field_data(scene.floor),
                    config.physics.timestep,
                    config.scene.floor_friction,
                    built_legs(robot.legs, build_errors(config.leg_odometry), seeds.robot),
                    robot.legs,
                    robot.gait.body_height,
                    robot.gait.stance_width};
}

/// The second output of the IMU: the same random draws give the same turn-on biases and scales.
std::optional<Imu> second_output(const SimulationConfig& config, Duration timestep,
                                 RunSeeds seeds) {
  if (config.fast_imu_rate <= 0.0) return std::nullopt;
  ImuConfig fast = config.imu;
  fast.rate = config.fast_imu_rate;
  return Imu(fast, timestep, seeds);
}

/// Random offset of the start position and heading, at most three sigma.
Placement start_offset(const RobotConfig& config, std::uint64_t seed) {
  RandomStream random(seed, "robot.start");
  const auto draw = [&random](double sigma) {
    return sigma * std::clamp(random.normal(), -3.0, 3.0);
  };
  Placement offset;
  offset.x = draw(config.start_position_sigma);
  offset.y = draw(config.start_position_sigma);
  offset.yaw = draw(config.start_heading_sigma);
  return offset;
}

/// One physics step under the push of that time.
void step_pushed(Walker& walker, const Pushes& pushes) {
  walker.world().push(pushes.force_at(walker.world().state().stamp));
  walker.step();
}

/// Waypoint times of the recording, without those before its start.
std::vector<WaypointTime> waypoint_times_since(const RouteFollower& route, Time start) {
  std::vector<WaypointTime> waypoint_times = route.waypoint_times();
  std::erase_if(waypoint_times, [start](const WaypointTime& each) { return each.stamp < start; });
  return waypoint_times;
}

/// The scene of that seed; error when the configuration is not valid or its route cannot be walked.
Result<Scene> walkable_scene(const SimulationConfig& config, std::uint64_t seed) {
  if (auto ok = validate(config); !ok) return tl::unexpected(ok.error());
  Scene scene = build_scene(config.scene, seed);
  auto walkable =
      check_walkable(config.route, scene, {config.robot.gait.body_height, config.robot.half_width});
  if (!walkable) {
    return failure(walkable.error().message + "; " + route_hint(config.scene.kind));
  }
  return scene;
}

/// With the points of its route.
SimulationConfig with_route(SimulationConfig config) {
  config.route = route_in(config.scene, config.route);
  return config;
}

}  // namespace

SensorRig nominal_rig(const SimulationConfig& config) {
  const Mounts mounts = nominal_mounts(config.robot.mounts);
  return {mounts.T_body_lidar, mounts.T_base_body.inverse(), config.robot.legs, config.imu.rate,
          config.leg_odometry.rate};
}

struct Simulation::Impl {
  Impl(const SimulationConfig& config, std::uint64_t seed, int threads, Scene built_scene,
       Walker ready_walker, WalkMonitor ready_monitor);

  void step();
  void record();
  void send_inertial(const TruthSample& motion);
  void send_legs();
  void send_scan();
  void cast(const Trajectory& motion, LidarScan& scan, bool delivered);
  void deliver(Time sent, Measurement measurement, Link& link);

  SimulationConfig config;
  Scene scene;
  Walker walker;
  WalkMonitor monitor;
  Pushes pushes;
  RayCaster caster;
  Lidar lidar;
  Imu imu;
  std::optional<Imu> fast_imu;
  LegOdometry legs;
  Link imu_link;
  Link leg_link;
  Link lidar_link;
  SensorRig rig;
  Trajectory scan_motion;  ///< of the LiDAR since the start of the present scan
  ScanTruth hits;          ///< of the last scan
  Arrivals arrivals;
  std::vector<Delivery> sent;
  std::vector<ImuSample> fast_samples;
  Truth truth;
  SimulationTimes times;
  BackgroundTasks casts;  ///< of scans; they alone use `lidar`, `hits` and `truth.scans`
};

Simulation::Impl::Impl(const SimulationConfig& c, std::uint64_t seed, int threads,
                       Scene built_scene, Walker ready_walker, WalkMonitor ready_monitor)
    : config(c),
      scene(std::move(built_scene)),
      walker(std::move(ready_walker)),
      monitor(ready_monitor),
      pushes(config.push, seed),
      caster(scene),
      lidar(config.lidar, caster, run_seeds(config, seed)),
      imu(config.imu, walker.world().timestep(), run_seeds(config, seed)),
      fast_imu(second_output(config, walker.world().timestep(), run_seeds(config, seed))),
      legs(config.leg_odometry, config.robot.legs, walker.world().timestep(),
           run_seeds(config, seed)),
      imu_link(config.links.imu, run_seeds(config, seed).run, "imu"),
      leg_link(config.links.leg_odometry, run_seeds(config, seed).run, "leg_odometry"),
      lidar_link(config.links.lidar, run_seeds(config, seed).run, "lidar"),
      rig(nominal_rig(config)),
      casts(threads) {
  truth.mounts = true_mounts(nominal_mounts(config.robot.mounts), config.calibration,
                             run_seeds(config, seed).robot);
  record();
}

void Simulation::Impl::deliver(Time now, Measurement measurement, Link& link) {
  sent.clear();
  link.send(now, std::move(measurement), sent);
  for (const Delivery& delivery : sent) arrivals.add(delivery);
}

void Simulation::Impl::send_inertial(const TruthSample& motion) {
  const FootLoads& loads = walker.world().state().foot_load;
  if (auto sample = imu.sample(motion, loads)) deliver(motion.stamp, *sample, imu_link);
  if (!fast_imu) return;
  if (auto sample = fast_imu->sample(motion, loads)) fast_samples.push_back(*sample);
}

void Simulation::Impl::send_legs() {
  const RobotState& state = walker.world().state();
  if (auto sample = legs.sample(state)) deliver(state.stamp, *sample, leg_link);
}

/// Sends the scan that ends now, if one does, without its points, which are cast until `advance`
/// returns; the next begins where it ended.
void Simulation::Impl::send_scan() {
  const RobotState& state = walker.world().state();
  scan_motion.push_back(
      {state.stamp, state.T_world_base * truth.mounts.T_base_body * truth.mounts.T_body_lidar});
  if (state.stamp - scan_motion.front().stamp < lidar.period()) return;
  auto scan = std::make_shared<LidarScan>();
  scan->stamp = scan_motion.front().stamp;
  scan->end = scan->stamp + lidar.period();
  deliver(state.stamp, LidarScanPtr(scan), lidar_link);
  const bool delivered = !sent.empty();
  // With errors of its stamps the link delivers another scan than it was given; no one has it yet.
  if (delivered) {
    scan = std::const_pointer_cast<LidarScan>(std::get<LidarScanPtr>(sent.front().measurement));
  }
  casts.add([this, motion = scan_motion, scan, delivered] { cast(motion, *scan, delivered); });
  scan_motion.erase(scan_motion.begin(), scan_motion.end() - 1);
}

/// Fills in the points of the scan over that motion of the LiDAR. One that was lost on its way is
/// cast as well: the noise of the others does not depend on it.
void Simulation::Impl::cast(const Trajectory& motion, LidarScan& scan, bool delivered) {
  const Stopwatch watch;
  LidarScan cast = lidar.scan(motion.front().stamp, motion, &hits);
  scan.points = std::move(cast.points);
  if (delivered) {
    const Pose T_world_lidar = pose_at(motion, cast.end).value_or(motion.back().pose);
    truth.scans.push_back(
        scan_information(cast.end, hits, T_world_lidar * truth.mounts.T_body_lidar.inverse(),
                         config.lidar.range_sigma, caster.first_moving_surface()));
  }
  times.lidar += watch.seconds();
}

/// Appends the present state to the truth and samples every sensor.
void Simulation::Impl::record() {
  const RobotState& state = walker.world().state();
  TruthSample sample;
  sample.stamp = state.stamp;
  sample.T_world_body = state.T_world_base * truth.mounts.T_base_body;
  const Eigen::Vector3d around = state.angular_velocity.cross(truth.mounts.T_base_body.translation);
  sample.velocity = state.velocity + state.T_world_base.rotation * around;
  sample.angular_velocity = truth.mounts.T_base_body.rotation.conjugate() * state.angular_velocity;
  sample.gyro_bias = imu.gyro_bias();
  sample.accelerometer_bias = imu.accelerometer_bias();
  sample.slip_speed = walker.world().slip_speed();
  truth.samples.push_back(sample);
  if (state.stamp % kSnapshotPeriod == 0) {
    truth.snapshots.push_back({state.stamp, walker.world().qpos()});
  }
  monitor.update(walker, scene.floor);
  truth.walk = monitor.outcome();
  send_inertial(sample);
  send_legs();
  send_scan();
}

void Simulation::Impl::step() {
  const Stopwatch watch;
  step_pushed(walker, pushes);
  times.physics += watch.seconds();
  record();
}

Result<void> check_walk(const SimulationConfig& config, std::uint64_t seed) {
  const auto scene = walkable_scene(with_route(config), seed);
  if (!scene) return tl::unexpected(scene.error());
  return {};
}

Result<Simulation> Simulation::create(const SimulationConfig& given, std::uint64_t seed,
                                      int threads) {
  const SimulationConfig config = with_route(given);
  auto scene = walkable_scene(config, seed);
  if (!scene) return tl::unexpected(scene.error());
  auto setup = world_setup(config, *scene, run_seeds(config, seed));
  if (!setup) return tl::unexpected(setup.error());
  auto walker =
      Walker::create(*setup, config.robot.gait, config.route, start_offset(config.robot, seed));
  if (!walker) return tl::unexpected(walker.error());
  if (walker->world().robot_inside_solid()) {
    return failure("route.points.0: the robot would start inside a wall or object of the scene");
  }
  walker->settle();
  const Pushes pushes(config.push, seed);
  WalkMonitor monitor(config.route, config.robot.gait.period, config.max_duration);
  while (to_seconds(walker->world().state().stamp) < config.recording_start && !monitor.ended()) {
    step_pushed(*walker, pushes);
    monitor.update(*walker, scene->floor);
  }
  return Simulation(std::make_unique<Impl>(config, seed, threads, std::move(*scene),
                                           std::move(*walker), monitor));
}

Simulation::Simulation(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Simulation::Simulation(Simulation&&) noexcept = default;
Simulation& Simulation::operator=(Simulation&&) noexcept = default;
Simulation::~Simulation() = default;

bool Simulation::advance(Duration span, std::vector<Delivery>& deliveries) {
  const Time until = now() + span;
  while (now() < until && !impl_->monitor.ended()) impl_->step();
  impl_->casts.wait();
  impl_->truth.waypoint_times =
      waypoint_times_since(impl_->walker.route(), impl_->truth.samples.front().stamp);
  const bool finished = impl_->monitor.ended();
  // At the end all pending packets arrive.
  impl_->arrivals.take(finished ? std::numeric_limits<Time>::max() : now(), deliveries);
  return !finished;
}

std::vector<ImuSample> Simulation::take_fast_imu() {
  return std::exchange(impl_->fast_samples, {});
}

Time Simulation::now() const { return impl_->walker.world().state().stamp; }
Duration Simulation::expected_duration() const {
  return from_seconds(nominal_duration(impl_->config.route));
}
const SensorRig& Simulation::rig() const { return impl_->rig; }
const Scene& Simulation::scene() const { return impl_->scene; }
const Truth& Simulation::truth() const { return impl_->truth; }
const SimulationTimes& Simulation::times() const { return impl_->times; }

}  // namespace aims
