// SPDX-License-Identifier: BSD-3-Clause
// Along-path errors of estimators in a closed-form corridor with recesses, seconds a run. Range
// noise is the only error of the LiDAR; IMU and legs have theirs
// (tests/support/kinematic_world.hpp).
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "bench/estimate/stream.hpp"
#include "bench/metrics/statistics.hpp"
#include "bench/scenario/seeds.hpp"
#include "estimator/estimator_spec.hpp"
#include "tests/support/kinematic_world.hpp"

namespace aims {
namespace {

/// Corridor beyond either end of the route [m].
constexpr double kBeyond = 60.0;

struct Options {
  std::vector<std::string> estimators{"aims_d", "tfs_plus", "lio"};  ///< specs, split at commas
  std::string seeds = "1-8";
  double length = 25.0;  ///< of the route [m]
  test::KinematicConfig world;
};

/// The error along the path at the end of the route, aligned at the first pose [m]: positive where
/// the estimate is too long.
double end_error(const Trajectory& trajectory, const test::KinematicWorld& world) {
  const StampedPose& first = trajectory.front();
  const StampedPose& last = trajectory.back();
  const Pose T_world_odom = world.T_world_body(first.stamp) * first.pose.inverse();
  const Eigen::Vector3d at = (T_world_odom * last.pose).translation;
  return at.x() - world.T_world_body(last.stamp).translation.x();
}

/// End errors by label [m].
using EndErrors = std::map<std::string, std::vector<double>>;

/// Adds the end error of every estimator of `specs` with the noise of one seed.
Result<void> add_end_errors(const test::KinematicConfig& config, std::span<const std::string> specs,
                            EndErrors& errors) {
  test::KinematicWorld world(config);
  auto estimators = make_estimators(specs, {}, world.rig());
  if (!estimators) return tl::unexpected(estimators.error());
  const auto next = [&](std::vector<Delivery>& batch) -> Result<bool> {
    return world.advance(kStreamBatch, batch);
  };
  stream(next, *estimators, 1, [] { return true; });
  for (const TimedEstimator& each : *estimators) {
    const Trajectory& trajectory = each.estimator().result().trajectory;
    if (trajectory.empty()) {
      return failure(fmt::format("{}: no pose, seed {}", each.name(), config.seed));
    }
    errors[each.name()].push_back(end_error(trajectory, world));
  }
  return {};
}

/// Mean with its deviation, which one error does not have, root mean square and largest value.
void print_row(const std::string& label, const std::vector<double>& errors, double length) {
  std::vector<double> squares;
  for (const double error : errors) squares.push_back(error * error);
  const double average = mean(errors).value();
  const double mean_square = mean(squares).value();
  const double variance = std::max(mean_square - average * average, 0.0);
  const auto others = static_cast<double>(errors.size() - 1);
  const std::string deviation =
      errors.size() < 2 ? "-" : fmt::format("{:.3f}", std::sqrt(variance / others));
  fmt::print("{:<40} {:+9.3f} ± {:<7} {:+9.2f} {:9.3f} {:9.3f}\n", label, average, deviation,
             100.0 * average / length, std::sqrt(mean_square),
             std::sqrt(std::ranges::max(squares)));
}

void add_options(CLI::App& app, Options& options) {
  test::CorridorShape& corridor = options.world.corridor;
  test::KinematicSensors& sensors = options.world.sensors;
  app.add_option("--estimators", options.estimators, "As for aims run (aims_d,tfs_plus,lio)")
      ->delimiter(',');
  app.add_option("--seeds", options.seeds, "Seeds of all noise (1-8)");
  app.add_option("--length", options.length, "Route, one way [m] (25)")
      ->check(CLI::Range(1.0, 1e3));
  app.add_option("--depth", corridor.recess_depth, "Recesses [m] (0.15)")
      ->check(CLI::Range(0.0, 1.0));
  app.add_option("--spacing", corridor.door_spacing, "From recess to recess [m] (8)")
      ->check(CLI::Range(1.0, 1e3));
  app.add_option("--width", corridor.width, "Of the corridor [m] (2.2)")
      ->check(CLI::Range(1.0, 20.0));
  app.add_option("--range", sensors.lidar_range, "Of the LiDAR [m] (30)")
      ->check(CLI::Range(2.0, 200.0));
  app.add_option("--range-noise", sensors.lidar_noise, "Of a return [m] (0.02)")
      ->check(CLI::Range(0.0, 0.5));
  app.add_option("--leg-scale-error", sensors.leg_scale_error,
                 "Legs report too short by [-] (0.045)")
      ->check(CLI::Range(-0.5, 0.5));
}

int refuse(const std::string& message) {
  fmt::print(stderr, "kinematic_corridor: {}\n", message);
  return 2;
}

int run(int argc, char** argv) {
  CLI::App app("Errors along a straight corridor with recesses, without physics");
  Options options;
  options.world.sensors.lidar_range = 30.0;
  add_options(app, options);
  CLI11_PARSE(app, argc, argv);
  options.world.corridor.open_ends = true;
  options.world.corridor.begin = -kBeyond;
  options.world.corridor.end = options.length + kBeyond;
  options.world.walk.distance = options.length;
  options.world.walk.there_and_back = false;
  const auto seeds = parse_seeds(options.seeds);
  if (!seeds) return refuse(seeds.error().message);
  const std::vector<std::string> specs = joined_specs(options.estimators);
  EndErrors errors;
  for (const std::uint64_t seed : *seeds) {
    options.world.seed = seed;
    const auto added = add_end_errors(options.world, specs, errors);
    if (!added) return refuse(added.error().message);
  }
  fmt::print("Error along the path after {} m, positive where too long, seeds {}\n", options.length,
             options.seeds);
  fmt::print("{:<40} {:>19} {:>9} {:>9} {:>9}\n", "estimator", "mean [m]", "[%]", "RMS [m]",
             "worst [m]");
  for (const auto& [label, each] : errors) print_row(label, each, options.length);
  return 0;
}

}  // namespace
}  // namespace aims

int main(int argc, char** argv) {
  try {
    return aims::run(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "kinematic_corridor: internal error: %s\n", error.what());
    return 3;
  }
}
