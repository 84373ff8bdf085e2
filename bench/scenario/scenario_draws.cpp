// SPDX-License-Identifier: BSD-3-Clause
#include "bench/scenario/scenario_draws.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <string_view>

#include "bench/scenario/scenario.hpp"
#include "core/files/number_lines.hpp"
#include "core/random.hpp"
#include "sim/robot/scene_route.hpp"

namespace aims {
namespace {

/// A condition of an entry, taken apart.
struct Condition {
  std::string key;
  std::string relation;  ///< "=", ">=" or "<="
  std::string value;
};

std::optional<Condition> parse_condition(const std::string& text) {
  const std::size_t at = text.find('=');
  if (at == std::string::npos || at == 0) return std::nullopt;
  const bool ordered = text[at - 1] == '>' || text[at - 1] == '<';
  const std::size_t end = ordered ? at - 1 : at;
  Condition condition{text.substr(0, end), text.substr(end, at + 1 - end), text.substr(at + 1)};
  if (condition.key.empty() || condition.value.empty()) return std::nullopt;
  return condition;
}

bool holds(const std::string& text, const Fields& fields) {
  const auto condition = parse_condition(text);
  const Parameter* parameter = condition ? fields.find(condition->key) : nullptr;
  if (parameter == nullptr) return false;
  const std::string value = parameter->text();
  if (condition->relation == "=" && !is_number(*parameter)) return value == condition->value;
  const auto left = parse_number(value);
  const auto right = parse_number(condition->value);
  if (!left || !right) return false;
  if (condition->relation == ">=") return *left >= *right;
  return condition->relation == "<=" ? *left <= *right : *left == *right;
}

/// The entry's value at `part` of its range, in [0, 1).
std::string value_at(const Draw& draw, double part) {
  if (!draw.values.empty()) {
    return draw.values[static_cast<std::size_t>(part * static_cast<double>(draw.values.size()))];
  }
  if (draw.integer) {
    return fmt::format("{:.0f}", draw.min + std::floor(part * (draw.max - draw.min + 1.0)));
  }
  const double value = draw.scale == DrawScale::kLog
                           ? draw.min * std::pow(draw.max / draw.min, part)
                           : draw.min + part * (draw.max - draw.min);
  // Rounded for readers, but never out of the range.
  const double rounded = parse_number(fmt::format("{:.6g}", value)).value_or(value);
  return fmt::format("{}", std::clamp(rounded, draw.min, draw.max));
}

/// The value that the entry draws on that seed; none when it is not drawn.
std::optional<std::string> drawn_value(const Draw& draw, std::uint64_t seed) {
  RandomStream random = rng(seed, "draw." + draw.key);
  const bool made = random.uniform() < draw.probability;
  const double part = random.uniform();
  if (!made) return std::nullopt;
  return value_at(draw, part);
}

/// Whether the key describes the robot, so that its draw stays over the runs of one robot.
bool is_of_robot(std::string_view key) {
  constexpr std::string_view kGroups[] = {"robot.", "imu.", "leg_odometry.", "lidar.",
                                          "calibration."};
  return std::ranges::any_of(kGroups, [&](std::string_view each) { return key.starts_with(each); });
}

Result<void> check_range(const Draw& draw, const std::string& name, const Parameter& parameter) {
  const bool log = draw.scale == DrawScale::kLog;
  if (!draw.values.empty()) {
    if (draw.min == 0.0 && draw.max == 0.0 && !log && !draw.integer) return {};
    return failure(name + ".values: expected either values or a range (min, max)");
  }
  if (!is_number(parameter)) {
    return failure(
        fmt::format("{}.key: '{}' is {}; expected values, since only numbers have ranges", name,
                    draw.key, parameter.expected));
  }
  if (!(draw.min < draw.max)) {
    return failure(
        fmt::format("{}.min: expected less than max ({}), got {}", name, draw.max, draw.min));
  }
  if (log && draw.min <= 0.0) {
    return failure(
        fmt::format("{}.min: expected more than 0 with scale: log, got {}", name, draw.min));
  }
  if (parameter.kind == ParameterKind::kInteger && !draw.integer) {
    return failure(fmt::format("{}.integer: expected true, since '{}' is {}", name, draw.key,
                               parameter.expected));
  }
  const bool whole = draw.min == std::round(draw.min) && draw.max == std::round(draw.max);
  if (draw.integer && (log || !whole)) {
    return failure(name + ".integer: expected whole numbers min and max and scale: linear");
  }
  return {};
}

/// Error for values that the key does not take. Ends of a range suffice: what a parameter allows is
/// an interval.
Result<void> check_values(const Draw& draw, const std::string& name, const Fields& fields) {
  std::vector<std::string> values = draw.values;
  const char* of = ".values";
  if (values.empty()) {
    of = "";
    values = {fmt::format("{}", draw.min), fmt::format("{}", draw.max)};
  }
  for (const std::string& value : values) {
    if (auto taken = assign(fields, draw.key, value); !taken) {
      return failure(fmt::format("{}{}: {}", name, of, taken.error().message));
    }
  }
  return {};
}

Result<void> check_condition(const std::string& text, const std::string& name, const Fields& fields,
                             const std::set<std::string>& drawn_later) {
  const auto condition = parse_condition(text);
  if (!condition) {
    return failure(
        fmt::format("{}: expected KEY=VALUE, KEY>=NUMBER or KEY<=NUMBER, got '{}'", name, text));
  }
  const Parameter* parameter = fields.find(condition->key);
  if (parameter == nullptr) {
    return failure(fmt::format("{}: {}", name, unknown_key_message(fields, condition->key)));
  }
  const bool ordered = condition->relation != "=";
  if ((ordered || is_number(*parameter)) &&
      (!is_number(*parameter) || !parse_number(condition->value))) {
    return failure(fmt::format("{}: expected numbers on both sides, got '{}'", name, text));
  }
  if (!drawn_later.contains(condition->key)) return {};
  return failure(fmt::format("{}: '{}' is drawn later; expected its entry before this one", name,
                             condition->key));
}

}  // namespace

void describe(Fields& f, Draw& d) {
  f.text("key", d.key, {.meaning = "key of the simulation that each seed draws"});
  f.number("min", d.min, {.unit = "as the key", .range = within(1e12), .meaning = "lower end"});
  f.number("max", d.max, {.unit = "as the key", .range = within(1e12), .meaning = "upper end"});
  f.choice("scale", d.scale, {{"linear", DrawScale::kLinear}, {"log", DrawScale::kLog}},
           {.meaning = "uniform in the number or in its logarithm"});
  f.flag("integer", d.integer, {.meaning = "whole numbers, both ends included"});
  f.texts("values", d.values, {.meaning = "equally likely values instead of a range"});
  f.number("probability", d.probability,
           {.unit = "-",
            .range = {.min = 0.0, .max = 1.0, .min_included = false},
            .meaning = "probability that the key is drawn; else the scenario's own value stays"});
  f.texts("when", d.when,
          {.meaning = "conditions KEY=VALUE, KEY>=NUMBER or KEY<=NUMBER; the first entry of a key "
                      "whose conditions all hold is drawn"});
}

Result<void> check_draws(const Scenario& scenario) {
  SimulationConfig simulation = scenario.simulation;
  const Fields fields = fields_of(simulation);
  std::multiset<std::string> left;
  for (const Draw& draw : scenario.draw) left.insert(draw.key);
  std::set<std::string> always;  // keys that an earlier entry draws in any case
  for (std::size_t i = 0; i < scenario.draw.size(); ++i) {
    const Draw& draw = scenario.draw[i];
    const std::string name = fmt::format("draw.{}", i);
    const Parameter* parameter = fields.find(draw.key);
    if (parameter == nullptr) {
      return failure(fmt::format("{}.key: {}", name, unknown_key_message(fields, draw.key)));
    }
    if (draw.key == "lidar.model" || draw.key == "robot.model") {
      return failure(
          fmt::format("{}.key: '{}' chooses figures below the scenario's own keys and cannot be "
                      "drawn; expected one scenario per model",
                      name, draw.key));
    }
    if (always.contains(draw.key)) {
      return failure(
          fmt::format("{}.key: an entry of '{}' without conditions stands before this "
                      "one, which is never drawn",
                      name, draw.key));
    }
    if (draw.when.empty()) always.insert(draw.key);
    const std::set<std::string> later(left.begin(), left.end());
    for (const std::string& condition : draw.when) {
      if (auto right = check_condition(condition, name + ".when", fields, later); !right) {
        return right;
      }
    }
    left.erase(left.find(draw.key));
    if (auto right = check_range(draw, name, *parameter); !right) return right;
    if (auto right = check_values(draw, name, fields); !right) return right;
  }
  return {};
}

void drop_set_draws(std::span<const AssignedKey> set, std::vector<Draw>& draws) {
  std::erase_if(draws, [&](const Draw& draw) {
    return std::ranges::any_of(set, [&](const AssignedKey& each) {
      return key_matches(each.key, draw.key) || key_matches(each.key, draw.key, true);
    });
  });
}

Scenario scenario_of_seed(const Scenario& scenario, std::uint64_t seed) {
  Scenario own = scenario;
  if (own.draw.empty()) return own;
  own.draw.clear();
  own.drawn.clear();
  const Fields fields = fields_of(own.simulation);
  const RunSeeds seeds = run_seeds(own.simulation, seed);
  std::set<std::string> settled;
  for (const Draw& draw : scenario.draw) {
    const auto met = [&](const std::string& condition) { return holds(condition, fields); };
    if (settled.contains(draw.key) || !std::ranges::all_of(draw.when, met)) continue;
    settled.insert(draw.key);
    const std::uint64_t of_draw = is_of_robot(draw.key) ? seeds.robot : seed;
    if (const auto value = drawn_value(draw, of_draw)) (void)assign(fields, draw.key, *value);
  }
  std::set<std::string> open;
  for (const Draw& draw : scenario.draw) {
    if (!open.insert(draw.key).second) continue;
    own.drawn.push_back({draw.key, fields.find(draw.key)->text()});
  }
  own.simulation.route = route_in(own.simulation.scene, own.simulation.route);
  return own;
}

std::shared_ptr<const Scenario> scenario_of_seed(std::shared_ptr<const Scenario> scenario,
                                                 std::uint64_t seed) {
  if (scenario->draw.empty()) return scenario;
  return std::make_shared<const Scenario>(scenario_of_seed(*scenario, seed));
}

Result<void> check_seeds_to_choose_on(const Scenario& scenario,
                                      std::span<const std::uint64_t> seeds) {
  if (scenario.draw.empty()) return {};
  for (const std::uint64_t seed : seeds) {
    if (seed < kFirstReportingSeed || seed > kLastReportingSeed) continue;
    return failure(fmt::format(
        "{}: seed {} is for reporting only: on a scenario with draws, nothing may be chosen on "
        "seeds {}-{}, or they would say nothing about new ones; expected e.g. seeds 1-200",
        scenario.name, seed, kFirstReportingSeed, kLastReportingSeed));
  }
  return {};
}

}  // namespace aims
