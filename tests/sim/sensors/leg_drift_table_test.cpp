// SPDX-License-Identifier: BSD-3-Clause
// Prints the drift of leg odometry by cause.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <map>
#include <string>
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

/// Copies the errors of one cause from the level `field`.
using Cause = std::function<void(LegOdometryConfig&, const LegOdometryConfig&)>;

const std::vector<std::pair<std::string, Cause>>& causes() {
  using Legs = LegOdometryConfig;
  static const std::vector<std::pair<std::string, Cause>> list = {
      {"none", [](Legs&, const Legs&) {}},
      {"angles: noise, offset, resolution",
       [](Legs& c, const Legs& field) {
         c.joint_angle_noise = field.joint_angle_noise;
         c.joint_angle_offset = field.joint_angle_offset;
         c.joint_angle_resolution = field.joint_angle_resolution;
       }},
      {"rates: window, noise",
       [](Legs& c, const Legs& field) {
         c.joint_rate_window = field.joint_rate_window;
         c.joint_rate_noise = field.joint_rate_noise;
       }},
      {"force sensor: lag",
       [](Legs& c, const Legs& field) { c.load_time_constant = field.load_time_constant; }},
      {"force sensor: offset, scale, noise",
       [](Legs& c, const Legs& field) {
         c.load_offset = field.load_offset;
         c.load_scale_error = field.load_scale_error;
         c.load_noise = field.load_noise;
       }},
      {"joint compliance",
       [](Legs& c, const Legs& field) { c.joint_stiffness = field.joint_stiffness; }},
      {"foot compliance",
       [](Legs& c, const Legs& field) { c.foot_stiffness = field.foot_stiffness; }},
      {"link lengths",
       [](Legs& c, const Legs& field) { c.link_length_error = field.link_length_error; }},
      {"all", [](Legs& c, const Legs& field) { c = field; }},
  };
  return list;
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
  const SimulationConfig field = config_at(SensorLevel::kField);
  for (const auto& [name, cause] : causes()) {
    SimulationConfig config = field;
    config.leg_odometry = without_errors(field.leg_odometry);
    cause(config.leg_odometry, field.leg_odometry);
    print(name, table.row(config, 0.7));
  }
  for (const double friction : {0.4, 1.0}) {
    print(fmt::format("all, friction {}", friction), table.row(field, friction));
  }
  for (const double on : {10.0, 40.0, 60.0}) {
    print(fmt::format("all, contact on {} N, off {} N", on, 0.5 * on),
          table.row(field_with(on), 0.7));
  }
}

TEST(LegDriftTable, ByCause) {
  print_table({1, 2, 3});
  print_table({11, 12, 13});
}

/// Compliance and contact timing act without a common factor: each cause reads short by itself.
TEST(LegDriftTable, NoCauseAloneMakesTheDrift) {
  DriftTable table({11, 12, 13});
  const SimulationConfig field = config_at(SensorLevel::kField);
  const double all = table.row(field, 0.7).rolling.mean();
  for (const auto& [name, cause] : causes()) {
    if (name == "all") continue;
    SimulationConfig config = field;
    config.leg_odometry = without_errors(field.leg_odometry);
    cause(config.leg_odometry, field.leg_odometry);
    EXPECT_LT(std::abs(table.row(config, 0.7).rolling.mean()), 0.6 * std::abs(all)) << name;
  }
}

}  // namespace
}  // namespace aims
