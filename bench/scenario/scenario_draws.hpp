// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/config.hpp"
#include "core/error.hpp"

namespace aims {

struct Scenario;

/// How a drawn number is spread over its range.
enum class DrawScale { kLinear, kLog };

/// One quantity that each seed draws, from the stream "draw.KEY": so that another entry
/// changes no value of this one.
struct Draw {
  std::string key;   ///< of the simulation, e.g. "scene.corridor.length"
  double min = 0.0;  ///< as the key's unit
  double max = 0.0;  ///< as the key's unit
  DrawScale scale = DrawScale::kLinear;
  bool integer = false;             ///< whole numbers, both ends included
  std::vector<std::string> values;  ///< equally likely, instead of a range
  double probability = 1.0;         ///< that it is drawn; else the scenario's own value stays [-]
  /// "KEY=VALUE", "KEY>=NUMBER" or "KEY<=NUMBER", which must all hold of the scenario as drawn so
  /// far. Of several entries of one key the first whose conditions hold is drawn.
  std::vector<std::string> when;

  bool operator==(const Draw&) const = default;
};

void describe(Fields& fields, Draw& draw);

/// A key that was open to be drawn, and the value that the scenario has on that seed.
struct DrawnValue {
  std::string key;
  std::string value;  ///< as in YAML

  bool operator==(const DrawnValue&) const = default;
};

/// Error for an entry that cannot be drawn; its message begins with the entry's key.
Result<void> check_draws(const Scenario& scenario);

/// Removes the entries of keys that settings have set: they keep the value given.
void drop_set_draws(std::span<const AssignedKey> set, std::vector<Draw>& draws);

/// The scenario on that seed: its draws made (`drawn`), none left, and the route along the scene
/// when it follows it. The same scenario when there is nothing to draw.
Scenario scenario_of_seed(const Scenario& scenario, std::uint64_t seed);

/// As above; the same object when there is nothing to draw.
std::shared_ptr<const Scenario> scenario_of_seed(std::shared_ptr<const Scenario> scenario,
                                                 std::uint64_t seed);

/// Seeds of scenarios with draws on which estimators are judged, and nothing is chosen.
inline constexpr std::uint64_t kFirstReportingSeed = 2001;
inline constexpr std::uint64_t kLastReportingSeed = 2400;

/// Error for seeds of that range when the scenario has draws, for commands that choose.
Result<void> check_seeds_to_choose_on(const Scenario& scenario,
                                      std::span<const std::uint64_t> seeds);

}  // namespace aims
