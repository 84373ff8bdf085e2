// SPDX-License-Identifier: BSD-3-Clause
// Prints the drift of leg odometry by cause.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "tests/sim/sensors/leg_drift.hpp"

namespace aims {
namespace {

using testing::config_at;
using testing::drift_of;
using testing::drift_walk;
using testing::LegDrift;
using testing::without_errors;

constexpr const char* kLateLoad = "force sensor: response";

/// Keys whose zero switches a cause off.
struct Cause {
  std::string name;
  std::vector<double LegOdometryConfig::*> keys;
};

const std::vector<Cause>& causes() {
  using Legs = LegOdometryConfig;
  static const std::vector<Cause> list = {
      {"angles: noise, offset, resolution",
       {&Legs::joint_angle_noise, &Legs::joint_angle_offset, &Legs::joint_angle_resolution}},
      {"rates: window, noise", {&Legs::joint_rate_window, &Legs::joint_rate_noise}},
      {"encoder delay", {&Legs::encoder_delay}},
      {kLateLoad,
       {&Legs::load_rise_time, &Legs::load_hold, &Legs::load_fall_time, &Legs::load_latency}},
      {"force sensor: offset, scale, noise",
       {&Legs::load_offset, &Legs::load_scale_error, &Legs::load_noise}},
      {"joint compliance", {&Legs::joint_stiffness}},
      {"foot compliance", {&Legs::foot_stiffness}},
      {"link lengths", {&Legs::link_length_error}}};
  return list;
}

/// The level `field` with no error of the legs.
SimulationConfig with_none() {
  SimulationConfig config = config_at(SensorLevel::kField);
  config.leg_odometry = without_errors(config.leg_odometry);
  return config;
}

SimulationConfig with_only(const Cause& cause) {
  const LegOdometryConfig field = config_at(SensorLevel::kField).leg_odometry;
  SimulationConfig config = with_none();
  for (const auto key : cause.keys) config.leg_odometry.*key = field.*key;
  return config;
}

SimulationConfig with_all_but(const Cause& cause) {
  SimulationConfig config = config_at(SensorLevel::kField);
  for (const auto key : cause.keys) config.leg_odometry.*key = 0.0;
  return config;
}

/// Mean over seeds of one configuration with either foot model.
struct Row {
  LegDrift point, rolling;
  double spread = 0.0;  ///< of the mean of out and back with point feet, largest less smallest
};

class DriftTable {
 public:
  explicit DriftTable(std::vector<std::uint64_t> seeds) : seeds_(std::move(seeds)) {}

  Row row(const SimulationConfig& config, double friction) {
    Row row;
    double least = 1.0;
    double largest = -1.0;
    for (const std::uint64_t seed : seeds_) {
      const testing::Walk& walk = walk_of(config, friction, seed);
      LegOdometryConfig legs = config.leg_odometry;
      legs.foot_model = FootModel::kPoint;
      const LegDrift point = drift_of(walk, legs, seed);
      add(row.point, point);
      least = std::min(least, point.mean());
      largest = std::max(largest, point.mean());
      legs.foot_model = FootModel::kRolling;
      add(row.rolling, drift_of(walk, legs, seed));
    }
    row.spread = largest - least;
    return row;
  }

 private:
  void add(LegDrift& sum, const LegDrift& drift) const {
    const auto share = 1.0 / static_cast<double>(seeds_.size());
    sum.out += share * drift.out;
    sum.back += share * drift.back;
    sum.turn += share * drift.turn;
    sum.height += share * drift.height;
  }

  /// Walks differ by the lengths of the legs and the friction.
  const testing::Walk& walk_of(const SimulationConfig& config, double friction,
                               std::uint64_t seed) {
    const double error = config.leg_odometry.link_length_error;
    const auto key = std::make_tuple(friction, error, error > 0.0 ? seed : 0);
    const auto found = walks_.find(key);
    if (found != walks_.end()) return found->second;
    return walks_.emplace(key, drift_walk(config, friction, seed)).first->second;
  }

  std::vector<std::uint64_t> seeds_;
  std::map<std::tuple<double, double, std::uint64_t>, testing::Walk> walks_;
};

void print(const std::string& name, const Row& row) {
  fmt::print("| {} | {:.1f} | {:.1f} | {:.1f} | {:.1f} | {:.1f} | {:.0f} | {:.1f} |\n", name,
             100.0 * row.point.out, 100.0 * row.point.back, 100.0 * row.spread,
             100.0 * row.rolling.out, 100.0 * row.rolling.back, 1e3 * row.rolling.turn,
             100.0 * row.rolling.height);
}

SimulationConfig field_with(double contact_on) {
  SimulationConfig config = config_at(SensorLevel::kField);
  config.leg_odometry.contact_on = contact_on;
  config.leg_odometry.contact_off = 0.5 * contact_on;
  return config;
}

void print_table(const std::vector<std::uint64_t>& seeds) {
  DriftTable table(seeds);
  fmt::print("| seeds {} to {} | point out | back | spread | rolling out | back | turn mm | z |\n",
             seeds.front(), seeds.back());
  const SimulationConfig none = with_none();
  const SimulationConfig field = config_at(SensorLevel::kField);
  print("none", table.row(none, 0.7));
  for (const Cause& cause : causes()) print(cause.name, table.row(with_only(cause), 0.7));
  print("all", table.row(field, 0.7));
  for (const Cause& cause : causes()) {
    print("all but " + cause.name, table.row(with_all_but(cause), 0.7));
  }
  for (const double friction : {0.4, 1.0}) {
    print(fmt::format("none, friction {}", friction), table.row(none, friction));
    print(fmt::format("all, friction {}", friction), table.row(field, friction));
  }
  SimulationConfig stiff = field;
  stiff.leg_odometry.joint_stiffness *= 2.0;
  print("all, joints twice as stiff", table.row(stiff, 0.7));
  for (const double on : {10.0, 40.0, 60.0}) {
    print(fmt::format("all, contact on {} N, off {} N", on, 0.5 * on),
          table.row(field_with(on), 0.7));
  }
}

/// The path of a square with corners, where the robot turns on the spot.
void print_square(const std::vector<std::uint64_t>& seeds) {
  for (const std::uint64_t seed : seeds) {
    SimulationConfig config = config_at(SensorLevel::kField);
    const testing::Walk walk = testing::square_walk(config, 0.7, seed);
    config.leg_odometry.foot_model = FootModel::kPoint;
    const double point = testing::path_error(walk, config, seed);
    config.leg_odometry.foot_model = FootModel::kRolling;
    const double rolling = testing::path_error(walk, config, seed);
    fmt::print("| square, seed {} | {:.1f} | {:.1f} |\n", seed, 100.0 * point, 100.0 * rolling);
  }
}

TEST(LegDriftTable, ByCause) {
  print_table({1, 2, 3});
  print_table({11, 12, 13});
  print_square({1, 2, 3, 11, 12, 13});
}

/// As on a real Go1: feet that count as standing while they already swing. No other cause makes half
/// of the drift, and without any other one more of it remains.
TEST(LegDriftTable, TheLateLoadIsTheMainCause) {
  DriftTable table({11, 12, 13});
  const double all = table.row(config_at(SensorLevel::kField), 0.7).rolling.mean();
  for (const Cause& cause : causes()) {
    const double alone = table.row(with_only(cause), 0.7).rolling.mean();
    const double without = table.row(with_all_but(cause), 0.7).rolling.mean();
    if (cause.name == kLateLoad) {
      EXPECT_LT(alone, 0.5 * all);
      EXPECT_GT(without, 0.75 * all);
    } else {
      EXPECT_GT(alone, 0.5 * all) << cause.name;
      EXPECT_LT(without, 0.75 * all) << cause.name;
    }
  }
}

}  // namespace
}  // namespace aims
