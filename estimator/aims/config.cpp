// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/aims/config.hpp"

namespace aims {
namespace {

constexpr double kLongTime = 60.0;  ///< bound on any duration asked for [s]

}  // namespace

void describe(Fields& f, ImuPropagationConfig& c) {
  f.choice("sampling", c.sampling, {{"mean", ImuSampling::kMean}, {"point", ImuSampling::kPoint}},
           {"", any(), "whether a sample is the mean over its interval or a point value",
            "design: 20 ms averages"});
  f.number("rate_hz", c.rate_hz, {"Hz", positive(), "nominal sample rate", "paper, III-A"});
  f.number("gravity", c.gravity, {"m/s^2", positive(), "magnitude of gravity"});
  f.number("gyro_noise", c.gyro_noise,
           {"rad/s/sqrt(Hz)", positive(), "white noise of the gyro, vibration included"});
  f.number("accelerometer_noise", c.accelerometer_noise,
           {"m/s^2/sqrt(Hz)", positive(), "white noise of the force, vibration included"});
  f.number("gyro_bias_walk", c.gyro_bias_walk,
           {"rad/s^2/sqrt(Hz)", positive(), "random walk of the gyro bias"});
  f.number("accelerometer_bias_walk", c.accelerometer_bias_walk,
           {"m/s^3/sqrt(Hz)", positive(), "random walk of the accelerometer bias"});
  f.number("bridge_gyro_noise", c.bridge_gyro_noise,
           {"rad/s/sqrt(Hz)", positive(), "gyro noise while samples are missing"});
  f.number("bridge_accelerometer_noise", c.bridge_accelerometer_noise,
           {"m/s^2/sqrt(Hz)", positive(), "force noise while samples are missing"});
  f.number("max_rate", c.max_rate, {"rad/s", positive(), "a faster turn is refused"});
  f.number("max_force", c.max_force, {"m/s^2", positive(), "a greater force is refused"});
}

void describe(Fields& f, InitializationConfig& c) {
  f.number("duration", c.duration, {"s", in_range(0.1, kLongTime), "standing still at the start"});
  f.number("settle", c.settle,
           {"s", in_range(0.0, kLongTime), "part of it that is left out of the averages"});
  f.number("still_rate", c.still_rate,
           {"rad/s", positive(), "angular rate above which the robot is taken to move"});
  f.number("still_force", c.still_force,
           {"m/s^2", positive(), "deviation of the force from gravity that means motion"});
  f.number("sigma_tilt", c.sigma_tilt, {"rad", positive(), "initial roll and pitch"});
  f.number("sigma_yaw", c.sigma_yaw, {"rad", positive(), "initial yaw, defined by the frame"});
  f.number("sigma_position", c.sigma_position,
           {"m", positive(), "initial position, defined by the frame"});
  f.number("sigma_velocity", c.sigma_velocity, {"m/s", positive(), "initial velocity"});
  f.number("sigma_velocity_moving", c.sigma_velocity_moving,
           {"m/s", positive(), "initial velocity of a robot that was not seen standing"});
  f.number("sigma_gyro_bias", c.sigma_gyro_bias,
           {"rad/s", positive(), "gyro bias after averaging"});
  f.number("sigma_accelerometer_bias", c.sigma_accelerometer_bias,
           {"m/s^2", positive(), "accelerometer bias, which standing cannot tell from tilt"});
}

void describe(Fields& f, LegConfig& c) {
  f.number("rate_hz", c.rate_hz, {"Hz", positive(), "nominal packet rate", "paper, III-A"});
  f.vector("velocity_sigma", c.velocity_sigma,
           {"m/s", positive(), "error of one sample along the base's axes, R_leg"});
  f.number("correlation_time", c.correlation_time,
           {"s", in_range(0.0, kLongTime),
            "for how long that error lasts; scales R_leg by the samples that repeat it"});
  f.number("scale_sigma", c.scale_sigma,
           {"-", at_least(0), "error in proportion to the speed, R_leg"});
  f.number("max_speed", c.max_speed, {"m/s", positive(), "a faster base is refused"});
}

void describe(Fields& f, LidarUpdateConfig& c) {
  f.number("min_range", c.min_range, {"m", at_least(0), "nearer returns are ignored"});
  f.number("max_range", c.max_range, {"m", positive(), "farther returns are ignored"});
  f.number("selection_voxel", c.selection_voxel,
           {"m", in_range(0.01, 10.0), "one return per voxel of the raw scan is matched"});
  f.integer("max_points", c.max_points, {"-", at_least(1), "most returns matched per scan"});
  f.number("point_sigma", c.point_sigma,
           {"m", positive(), "error of a point-to-plane residual, R_lidar",
            "tuned on simulated corridors, with doors and smooth"});
  f.number("residual_gate", c.residual_gate,
           {"m", positive(), "point-to-plane residuals beyond it are refused"});
  f.integer("max_iterations", c.max_iterations,
            {"-", in_range(1, 50), "most iterations of the trial update"});
  f.number("convergence_rotation", c.convergence_rotation,
           {"rad", positive(), "smaller steps end the iteration"});
  f.number("convergence_position", c.convergence_position,
           {"m", positive(), "smaller steps end the iteration"});
  f.number("research_rotation", c.research_rotation,
           {"rad", positive(), "larger rotations renew the neighbours"});
  f.number("research_position", c.research_position,
           {"m", positive(), "larger shifts renew the neighbours"});
  f.integer("min_matches", c.min_matches,
            {"-", at_least(6), "a scan with fewer planes corrects nothing"});
}

void describe(Fields& f, MapConfig& c) {
  f.number("voxel_size", c.voxel_size,
           {"m", in_range(0.05, 10.0), "edge of a voxel of the local map"});
  f.number("point_spacing", c.point_spacing,
           {"m", at_least(0), "returns nearer to a map point merge into it"});
  f.integer("max_points_per_voxel", c.max_points_per_voxel,
            {"-", in_range(5, 32), "most map points per voxel"});
  f.integer("max_merges", c.max_merges,
            {"-", in_range(1, 255), "returns that a map point averages before it is frozen"});
  f.integer("max_voxels", c.max_voxels,
            {"-", at_least(100), "bound on voxels; the farthest are dropped"});
  f.number("insertion_voxel", c.insertion_voxel,
           {"m", in_range(0.01, 10.0), "one return per voxel of the raw scan is mapped"});
  f.integer("max_insertions", c.max_insertions, {"-", at_least(1), "most returns mapped per scan"});
  f.number("neighbor_gate", c.neighbor_gate,
           {"m", positive(), "the five neighbours lie within it (at most one voxel)"});
  f.number("plane_thickness", c.plane_thickness,
           {"m", positive(), "the five neighbours lie this close to their plane"});
  f.number(
      "plane_min_spread", c.plane_min_spread,
      {"m", at_least(0), "least second principal deviation of the neighbours; docs/decisions.md"});
  f.number("plane_min_ratio", c.plane_min_ratio,
           {"-", at_least(1),
            "least ratio of second to smallest principal variance; docs/decisions.md"});
  f.number("map_sigma", c.map_sigma,
           {"m", positive(), "least error of a map point across its plane"});
}

void describe(Fields& f, DegeneracyConfig& c) {
  f.flag("prior_residuals", c.prior_residuals,
         {"", any(), "O_lidar from the residuals before the trial update", "eq. (4)"});
  f.number("sigma_0", c.sigma_0, {"m", positive(), "nominal residual dispersion", "eq. (4)"});
  f.number("kappa", c.kappa,
           {"-", positive(), "saturation of C_IL; chi-square of 6 dof at 95 %", "eq. (7)"});
  f.number("w1", c.w1, {"-", in_range(0.0, 1.0), "weight of 1 - O_lidar; w2 = 1 - w1", "eq. (7)"});
  f.number("eta", c.eta, {"-", at_least(0), "LiDAR sensitivity to degeneration", "eq. (8)"});
  f.number("gamma_min", c.gamma_min,
           {"-", in_range(0.01, 1.0), "least reliability of the legs", "eq. (10)"});
  f.number("alpha", c.alpha,
           {"-", in_half_open(0.0, 1.0), "smoothing of D_k per scan", "eq. (12)"});
}

void describe(Fields& f, QueueConfig& c) {
  f.number("lag", c.lag,
           {"s", in_range(0.0, kLongTime), "measurements wait this long for earlier ones"});
  f.number("imu_wait", c.imu_wait,
           {"s", in_range(0.0, kLongTime), "corrections wait this long for the IMU"});
  f.number("max_ahead", c.max_ahead,
           {"s", positive(), "a stamp further ahead of its arrival is refused"});
  f.integer("max_held", c.max_held, {"-", at_least(100), "bound on measurements held back"});
}

void describe(Fields& f, EstimatorConfig& c) {
  f.group("imu", c.imu);
  f.group("initialization", c.initialization);
  f.group("leg", c.leg);
  f.group("lidar", c.lidar);
  f.group("map", c.map);
  f.group("degeneracy", c.degeneracy);
  f.group("directional", c.directional);
  f.group("queue", c.queue);
}

EstimatorConfig config_of(const FamilyMember& member, EstimatorConfig config) {
  if (!member.directional) config.directional = without_parts();
  return config;
}

}  // namespace aims
