// SPDX-License-Identifier: BSD-3-Clause
#include "live/live_options.hpp"

namespace aims {
namespace {

std::string is_frame(const std::string& name) { return name.empty() ? "expected a name" : ""; }

}  // namespace

void add_live_options(CLI::App& app, LiveOptions& options) {
  app.add_option("--estimator,--estimators", options.estimator, "Estimator to run (aims_d)");
  app.add_option(
      "--robot", options.robot,
      "Topics of a robot: simulated, anymal, go2, ouster, livox, or a YAML file like theirs");
  app.add_option("--config", options.config, "YAML file with recording, estimator");
  app.add_option("--calibration", options.calibration,
                 "Calibration of the robot, a file of `aims calibrate`:\n"
                 "a prior that the data can overrule (none)");
  app.add_option("--set", options.overrides, "key=value, applied after the file; repeatable")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  app.add_option("--out", options.out,
                 "Folder for trajectory, health, counts and map, as they come");
  app.add_option("--record", options.record,
                 "Recording to write of the messages read: .mcap under ROS 2, .bag under ROS 1");
  app.add_option("--odom-frame,--odom_frame", options.odom_frame,
                 "Frame of the published poses (odom)")
      ->check(is_frame);
  app.add_option("--body-frame,--body_frame", options.body_frame, "Frame of the IMU (imu)")
      ->check(is_frame);
  app.add_flag("--tf", options.tf, "Also publish the pose on /tf");
  app.add_option(
         "--settle", options.settle,
         "Time [s] for which each topic must have come before topics and units are decided (3)")
      ->check(CLI::Range(0.1, 60.0));
  app.add_option("--patience", options.patience,
                 "Timeout [s] without the needed topics; 0: none (0)")
      ->check(CLI::Range(0.0, 1e6));
  app.add_option("--max-wait,--max_wait", options.max_wait,
                 "A cloud that has waited longer [s] is dropped for a newer one (0.05)")
      ->check(CLI::Range(0.05, 20.0));
}

}  // namespace aims
