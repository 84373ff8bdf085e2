// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/baselines/leg_kilo/config.hpp"

namespace aims::leg_kilo {
namespace {

const std::string kProgram = "published program";
const std::string kParameters = "published program, config/leg_fusion.yaml";

}  // namespace

void describe(Fields& f, Start& c) {
  f.number("variance", c.variance,
           {"SI^2", positive_up_to(1e6), "of every entry of the error state", kProgram});
}

void describe(Fields& f, Points& c) {
  f.integer("every_nth", c.every_nth,
            {"-", in_range(1, 1000), "one return of this many is used, in order of firing",
             kParameters + ", filter_num"});
  f.number("min_range", c.min_range,
           {"m", up_to(1e3), "nearer returns are dropped", kParameters + ", blind 1.5"});
  f.number("time_step", c.time_step,
           {"s", in_range(1e-6, 1.0), "firing times are rounded to its multiples", kProgram});
  f.number("voxel", c.voxel,
           {"m", in_range(0.01, 10.0),
            "edge of the voxels of which each gives its centroid, at the mean time",
            kParameters + ", voxel_grid_resolution"});
}

void describe(Fields& f, PointNoise& c) {
  f.number("range_sigma", c.range_sigma,
           {"m", positive_up_to(1e3), "deviation of a range", kParameters + ", dept_err"});
  f.number("beam_sigma_deg", c.beam_sigma_deg,
           {"deg", positive_up_to(90.0), "deviation of a beam's direction, along each axis",
            kParameters + ", beam_err"});
}

void describe(Fields& f, ImuVariances& c) {
  const Range variance = positive_up_to(1e6);
  f.number("force", c.force,
           {"m^2/s^4", variance, "of the specific force along x and y", kParameters});
  f.number("vertical_force", c.vertical_force,
           {"m^2/s^4", variance, "of the specific force along z", kParameters});
  f.number("rate", c.rate, {"rad^2/s^2", variance, "of the angular rate, per axis", kParameters});
}

void describe(Fields& f, Legs& c) {
  f.flag("enabled", c.enabled,
         {"", any(), "use the legs; false: IMU and LiDAR alone", kParameters + ", only_imu_use"});
  f.choice("feet", c.feet, {{"twist", FeetFrom::kTwist}, {"contacts", FeetFrom::kContacts}},
           {"", any(),
            "standing feet: four whose joints would report the leg odometry's twist, or those in "
            "contact, by their joints (without joints: as twist)"});
  f.number("variance", c.variance,
           {"m^2/s^2", positive_up_to(1e6), "of the velocity of a standing foot, per axis",
            kParameters + ", kin_meas_noise"});
  f.number("max_age", c.max_age,
           {"s", positive_up_to(60.0), "leg data as old as this belong to no IMU sample"});
  f.number("force_begin", c.force_begin,
           {"N", within(1e6), "a greater force begins a contact, in streams with forces",
            kParameters + ", contact_force_threshold_up, in the counts of a Go1"});
  f.number("force_end", c.force_end,
           {"N", within(1e6), "a smaller force ends a contact",
            kParameters + ", contact_force_threshold_down, in the counts of a Go1"});
  f.idle_if(c.feet == FeetFrom::kTwist, "feet is twist", {"force_begin", "force_end"});
}

void describe(Fields& f, Residuals& c) {
  f.number("gate", c.gate,
           {"-", positive_up_to(1e3), "greatest distance from a plane, in its deviations",
            kParameters + ", sigma_num"});
  f.number("max_extent", c.max_extent,
           {"-", positive_up_to(1e3),
            "greatest distance from a plane's centre, in deviations of its points", kProgram});
  f.number("variance_factor", c.variance_factor,
           {"-", positive_up_to(1e6), "on the variance of a distance",
            kParameters + ", lidar_point_meas_ratio"});
}

void describe(Fields& f, Map& c) {
  f.number("voxel", c.voxel,
           {"m", in_range(0.1, 10.0), "edge of a voxel", kParameters + ", voxel_size"});
  f.integer("layers", c.layers,
            {"-", in_range(0, 4), "times that a voxel without a plane is divided in eight",
             kParameters + ", max_layer"});
  f.integer("min_points", c.min_points,
            {"-", in_range(3, 1000), "more points make a plane", kParameters + ", layer_init_num"});
  f.integer("refit_points", c.refit_points,
            {"-", in_range(0, 1000), "more new points renew a plane", kProgram});
  f.integer("max_points", c.max_points,
            {"-", in_range(3, 1000), "a plane of more points is final",
             kParameters + ", max_points_num"});
  f.number("max_eigenvalue", c.max_eigenvalue,
           {"m^2", positive_up_to(1e3), "smallest eigenvalue of the covariance of a plane's points",
            kParameters + ", min_eigen_value"});
}

void describe(Fields& f, Config& c) {
  f.group("start", c.start);
  f.group("process_noise", c.process_noise);
  f.group("points", c.points);
  f.group("point_noise", c.point_noise);
  f.group("imu", c.imu);
  f.group("legs", c.legs);
  f.group("residuals", c.residuals);
  f.group("map", c.map);
  f.group("queue", c.queue);
}

Requirements requirements_of(const Config& config) {
  const bool legs = config.legs.enabled;
  return {.lidar = true,
          .imu = true,
          .legs = legs,
          .joints = legs && config.legs.feet == FeetFrom::kContacts,
          .point_times = true};
}

Config published() {
  Config config;
  config.points.min_range = 1.5;
  return config;
}

}  // namespace aims::leg_kilo
