// SPDX-License-Identifier: BSD-3-Clause
#include "lab/order/order_study.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <set>
#include <span>

#include "bench/metrics/statistics.hpp"
#include "bench/scoring/validity.hpp"
#include "bench/studies/drawn_groups.hpp"
#include "bench/studies/paper_study.hpp"

namespace aims {
namespace {

constexpr std::uint64_t kOrderBootstrapSeed = 1;

using Units = std::vector<const OrderUnit*>;

std::map<std::string, double> conditions_of(const RunRecord& run) {
  std::map<std::string, double> conditions;
  const auto drawn = run.scores.find("drawn");
  if (drawn == run.scores.end() || !drawn->is_object()) return conditions;
  for (const auto& [key, value] : drawn->items()) {
    if (value.is_number()) conditions[key] = value.get<double>();
  }
  return conditions;
}

/// Mean over the columns of the paper's table of the corridor.
std::optional<double> agreement(const RunRecord& run) {
  const PaperTable& table = *paper_table_of("corridor");
  std::vector<double> taus;
  for (std::size_t i = 0; i < table.scores.size(); ++i) {
    if (const auto tau = paper_tau(table, i, std::span(&run, 1)).tau) taus.push_back(*tau);
  }
  return mean(taus);
}

std::optional<OrderUnit> unit_of(const std::string& scenario, const RunRecord& run,
                                 const OrderOptions& options) {
  const auto adaptive = find_score(run, options.adaptive, options.score);
  const auto fixed = find_score(run, options.fixed, options.score);
  if (!adaptive || !fixed || invalid_reason(run.scores)) return std::nullopt;
  return OrderUnit{scenario, run.seed, conditions_of(run), *fixed - *adaptive, agreement(run)};
}

std::vector<double> advantages(const Units& units) {
  std::vector<double> values;
  for (const OrderUnit* unit : units) values.push_back(unit->advantage);
  return values;
}

/// The condition in each unit, all of which drew it.
std::vector<double> drawn_values(const Units& units, const std::string& key) {
  std::vector<double> values;
  for (const OrderUnit* unit : units) values.push_back(unit->conditions.at(key));
  return values;
}

/// 95 % bootstrap interval over units of what `statistic` makes of them.
Interval interval_of(const Units& units,
                     const std::function<std::optional<double>(const Units&)>& statistic) {
  return bootstrap_interval(
      units.size(),
      [&](std::span<const std::size_t> chosen) {
        Units drawn;
        for (const std::size_t i : chosen) drawn.push_back(units[i]);
        return statistic(drawn);
      },
      kOrderBootstrapSeed);
}

OrderBin bin_of(const Units& units) {
  OrderBin bin;
  bin.units = units.size();
  bin.better = static_cast<std::size_t>(
      std::ranges::count_if(units, [](const OrderUnit* unit) { return unit->advantage > 0.0; }));
  bin.advantage = median(advantages(units)).value_or(0.0);
  bin.interval = interval_of(units, [](const Units& drawn) { return median(advantages(drawn)); });
  std::vector<double> taus;
  for (const OrderUnit* unit : units) {
    if (unit->tau) taus.push_back(*unit->tau);
  }
  bin.tau = mean(taus);
  return bin;
}

/// The units that drew the condition, by bin of it.
std::vector<Units> binned(const Units& units, const std::string& key, std::size_t bins) {
  const std::vector<double> ends = upper_ends(drawn_values(units, key), bins);
  std::vector<Units> members(ends.size());
  for (const OrderUnit* unit : units) {
    const auto end = std::ranges::lower_bound(ends, unit->conditions.at(key));
    members[static_cast<std::size_t>(end - ends.begin())].push_back(unit);
  }
  return members;
}

std::optional<double> association_of(const Units& units, const std::string& key) {
  return kendall_tau(drawn_values(units, key), advantages(units));
}

std::optional<double> tau_association_of(const Units& units, const std::string& key) {
  std::vector<double> values;
  std::vector<double> taus;
  for (const OrderUnit* unit : units) {
    if (!unit->tau) continue;
    values.push_back(unit->conditions.at(key));
    taus.push_back(*unit->tau);
  }
  return kendall_tau(values, taus);
}

OrderCondition condition_of(const Units& units, const std::string& key, std::size_t bins) {
  OrderCondition condition;
  condition.key = key;
  condition.association = association_of(units, key).value_or(0.0);
  condition.interval =
      interval_of(units, [&key](const Units& drawn) { return association_of(drawn, key); });
  condition.tau_association = tau_association_of(units, key);
  for (const Units& members : binned(units, key, bins)) {
    OrderBin bin = bin_of(members);
    const auto value = [&key](const OrderUnit* unit) { return unit->conditions.at(key); };
    const auto [low, high] = std::ranges::minmax(members, {}, value);
    bin.low = value(low);
    bin.high = value(high);
    condition.bins.push_back(bin);
  }
  return condition;
}

Units with_condition(const Units& units, const std::string& key) {
  Units chosen;
  std::ranges::copy_if(units, std::back_inserter(chosen),
                       [&key](const OrderUnit* unit) { return unit->conditions.contains(key); });
  return chosen;
}

double middle_of(const Units& units, const std::string& key) {
  return median(drawn_values(units, key)).value_or(0.0);
}

OrderMap map_of(const Units& all, const std::string& x, const std::string& y, std::size_t bins) {
  OrderMap map{x, y, {}};
  const Units units = with_condition(with_condition(all, x), y);
  const std::vector<Units> columns = binned(units, x, bins);
  for (const Units& row : binned(units, y, bins)) {
    for (const Units& column : columns) {
      Units cell;
      std::ranges::copy_if(row, std::back_inserter(cell), [&column](const OrderUnit* unit) {
        return std::ranges::find(column, unit) != column.end();
      });
      map.cells.push_back({middle_of(column, x), middle_of(row, y), std::nullopt});
      if (!cell.empty()) map.cells.back().bin = bin_of(cell);
    }
  }
  return map;
}

void collect_units(const StoredResults& results, OrderStudy& study) {
  for (const auto& [scenario, runs] : results) {
    for (const RunRecord& run : runs) {
      if (auto unit = unit_of(scenario, run, study.options)) {
        study.units.push_back(std::move(*unit));
      } else {
        ++study.left_out;
      }
    }
  }
}

}  // namespace

Result<OrderStudy> order_study(const StoredResults& results, const OrderOptions& options) {
  OrderStudy study;
  study.options = options;
  collect_units(results, study);
  Units units;
  std::set<std::string> keys;
  for (const OrderUnit& unit : study.units) {
    units.push_back(&unit);
    for (const auto& [key, unused] : unit.conditions) keys.insert(key);
  }
  if (keys.empty()) {
    return failure(fmt::format(
        "no valid run of a scenario with drawn numbers has {} of both {} and {}; expected results "
        "of random_conditions or the like",
        options.score, options.adaptive, options.fixed));
  }
  study.all = bin_of(units);
  for (const std::string& key : keys) {
    study.conditions.push_back(condition_of(with_condition(units, key), key, options.bins));
  }
  std::ranges::stable_sort(study.conditions, std::ranges::greater{},
                           [](const auto& condition) { return std::abs(condition.association); });
  if (study.conditions.size() > 1) {
    study.map = map_of(units, study.conditions[0].key, study.conditions[1].key, options.bins);
  }
  return study;
}

}  // namespace aims
