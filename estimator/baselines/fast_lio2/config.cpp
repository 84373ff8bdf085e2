// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/baselines/fast_lio2/config.hpp"

namespace aims::fast_lio2 {
namespace {

const std::string kPaper = "Xu, Cai, He, Lin, Zhang 2022 (T-RO 38)";
const std::string kProgram = "published program";

}  // namespace

void describe(Fields& f, Start& c) {
  const Range variance = positive_up_to(1e6);
  f.integer("min_samples", c.min_samples,
            {"-", in_range(1, 100000), "IMU samples that are averaged, at least", kProgram});
  f.number("extrinsic_rotation_variance", c.extrinsic_rotation_variance,
           {"rad^2", variance, "of the LiDAR's mount, per axis", kProgram});
  f.number("extrinsic_translation_variance", c.extrinsic_translation_variance,
           {"m^2", variance, "of the LiDAR's mount, per axis", kProgram});
  f.number("gyro_bias_variance", c.gyro_bias_variance,
           {"rad^2/s^2", variance, "of the gyro's bias, per axis", kProgram});
  f.number("accelerometer_bias_variance", c.accelerometer_bias_variance,
           {"m^2/s^4", variance, "of the accelerometer's bias, per axis", kProgram});
  f.number("gravity_variance", c.gravity_variance,
           {"rad^2", variance, "of the direction of gravity, per axis", kProgram});
  f.number("pose_variance", c.pose_variance,
           {"m^2, rad^2", variance, "of position and rotation, per axis", kProgram});
  f.number("velocity_variance", c.velocity_variance,
           {"m^2/s^2", variance, "of the velocity, per axis", kProgram});
}

void describe(Fields& f, Points& c) {
  f.integer("every_nth", c.every_nth,
            {"-", in_range(1, 1000), "one return of this many is used, in order of firing",
             kProgram + ", point_filter_num 4"});
  f.number("min_range", c.min_range,
           {"m", up_to(1e3), "nearer returns are dropped", kProgram + ", blind 2"});
  f.number("voxel", c.voxel,
           {"m", in_range(0.01, 10.0), "edge of the voxels of which each gives its centroid",
            kProgram + ", filter_size_surf 0.5"});
}

void describe(Fields& f, Residuals& c) {
  f.number("max_squared_distance", c.max_squared_distance,
           {"m^2", positive_up_to(1e4), "of the fifth neighbour", kProgram});
  f.number("plane_threshold", c.plane_threshold,
           {"m", positive_up_to(10.0), "greatest distance of a neighbour from the plane",
            kPaper + ", sec. V-A"});
  f.number(
      "score_slope", c.score_slope,
      {"1/sqrt(m)", positive_up_to(100.0), "slope in s = 1 - slope |d| / sqrt(range)", kProgram});
  f.number("min_score", c.min_score,
           {"-", in_range(-100.0, 1.0), "points with a smaller s are left out", kProgram});
  f.number("variance", c.variance,
           {"m^2", positive_up_to(1e3), "R of each residual", kProgram + ", LASER_POINT_COV"});
}

void describe(Fields& f, Iterations& c) {
  f.integer(
      "max", c.max,
      {"-", in_range(1, 100), "iterations after the first one", kProgram + ", max_iteration"});
  f.number("convergence", c.convergence,
           {"m, rad, ...", positive_up_to(1.0), "greatest change of an entry of the error state",
            kProgram});
  f.flag("estimate_extrinsic", c.estimate_extrinsic,
         {"-", any(), "whether the LiDAR's mount is estimated", kPaper + ", eq. (2)"});
}

void describe(Fields& f, Map& c) {
  f.number("voxel", c.voxel,
           {"m", in_range(0.01, 10.0), "edge of the voxels of which each keeps one point",
            kPaper + ", sec. V-C"});
  f.number("cube", c.cube, {"m", in_range(1.0, 1e5), "edge of the local map", kPaper});
  f.number("detection_range", c.detection_range,
           {"m", positive_up_to(1e4), "of the LiDAR; the local map stays ahead of it", kPaper});
  f.number("moving_factor", c.moving_factor,
           {"-", in_range(1.0, 100.0),
            "the local map moves when a face is nearer than this times "
            "detection_range",
            kPaper + ", fig. 3"});
}

void describe(Fields& f, Config& c) {
  f.group("start", c.start);
  f.group("process_noise", c.process_noise);
  f.group("points", c.points);
  f.group("residuals", c.residuals);
  f.group("iterations", c.iterations);
  f.group("map", c.map);
  f.group("queue", c.queue);
  f.idle_if(!c.iterations.estimate_extrinsic, "iterations.estimate_extrinsic is false",
            {"start.extrinsic_rotation_variance", "start.extrinsic_translation_variance"});
}

Requirements requirements_of(const Config&) {
  return {.lidar = true, .imu = true, .point_times = true};
}

Config published() {
  Config config;
  config.points.every_nth = 4;
  config.points.min_range = 2.0;
  return config;
}

}  // namespace aims::fast_lio2
