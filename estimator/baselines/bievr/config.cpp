// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/baselines/bievr/config.hpp"

namespace aims::bievr {
namespace {

const std::string kParameters = "published program, config/params.yaml";
const std::string kProgram = "published program";

}  // namespace

void describe(Fields& f, Points& c) {
  f.number("min_range", c.min_range, {"m", up_to(1e3), "nearer returns are dropped", kProgram});
  f.number("max_range", c.max_range,
           {"m", positive_up_to(1e4), "farther returns are dropped", kProgram});
  f.number("voxel", c.voxel,
           {"m", in_range(0.01, 10.0),
            "edge of the voxels of which each keeps the return nearest to its centre",
            kParameters + ", downsample_resolution_m"});
  f.flag("informed_sampling", c.informed_sampling,
         {"-", any(), "keep all points in map voxels of much relief and one in each other",
          kParameters});
  f.integer("informed_voxels", c.informed_voxels,
            {"-", in_range(1, 1000000),
             "map voxels of most relief, of which all points are matched", kProgram});
  f.idle_if(!c.informed_sampling, "informed_sampling is false", {"informed_voxels"});
}

void describe(Fields& f, MapConfig& c) {
  f.number("pixel", c.pixel, {"m", in_range(0.005, 10.0), "edge of a pixel", kParameters});
  f.number("voxel", c.voxel, {"m", in_range(0.02, 100.0), "edge of a voxel", kParameters});
  f.number(
      "normal_tolerance", c.normal_tolerance,
      {"deg", in_range(0.01, 90.0), "a normal that turns further gets a new image", kParameters});
  f.flag("smooth", c.smooth,
         {"-", any(), "match the heights averaged over 3 x 3 pixels", kParameters});
  f.flag("weighted", c.weighted,
         {"-", any(), "points count by one over their range, 1/2 at most", kParameters});
  f.integer("max_voxels", c.max_voxels,
            {"-", in_range(100, 100000000), "those not seen for longest are dropped beyond",
             kParameters + ", max_size"});
}

void describe(Fields& f, RegistrationConfig& c) {
  f.number("huber", c.huber,
           {"m", positive_up_to(1e3), "residuals beyond count linearly", kParameters});
  f.integer("max_iterations", c.max_iterations, {"-", in_range(1, 1000), "steps", kProgram});
  f.integer("max_attempts", c.max_attempts,
            {"-", in_range(1, 1000), "dampings tried per step", kProgram});
  f.number("rotation_epsilon", c.rotation_epsilon,
           {"-", positive_up_to(1.0),
            "no entry of the rotation matrix of the last step changes "
            "more",
            kProgram});
  f.number("position_epsilon", c.position_epsilon,
           {"m", positive_up_to(1.0), "nor of its translation", kProgram});
  f.number("first_damping", c.first_damping,
           {"-", positive_up_to(1e6), "of the largest diagonal entry of the Hessian", kProgram});
  f.flag("relief", c.relief,
         {"-", any(), "match with the heights, not with the planes of the voxels", kProgram});
}

void describe(Fields& f, InertialConfig& c) {
  f.number("start", c.start,
           {"s", positive_up_to(1e3), "standing time that gives the first biases", kParameters});
  f.number("window", c.window, {"s", positive_up_to(1e3), "of the poses", kParameters});
  f.integer("min_intervals", c.min_intervals,
            {"-", in_range(1, 1000), "between poses, before the first solution", kProgram});
  f.integer("min_voxels", c.min_voxels,
            {"-", in_range(0, 1000000), "of the map, before a pose counts", kProgram});
  f.number("gravity_weight", c.gravity_weight,
           {"-", positive_up_to(1e6), "of the last direction of gravity", kProgram});
}

void describe(Fields& f, Config& c) {
  f.group("points", c.points);
  f.group("map", c.map);
  f.group("registration", c.registration);
  f.group("inertial", c.inertial);
  f.group("queue", c.queue);
}

Requirements requirements_of(const Config&) {
  return {.lidar = true, .imu = true, .point_times = true};
}

}  // namespace aims::bievr
