// SPDX-License-Identifier: BSD-3-Clause
#include "bench/studies/families.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "bench/metrics/paired_test.hpp"
#include "bench/metrics/statistics.hpp"
#include "bench/scoring/json_text.hpp"
#include "bench/scoring/score_statistics.hpp"
#include "bench/studies/suite_summary.hpp"
#include "estimator/estimator_spec.hpp"

namespace aims {
namespace {

constexpr const char* kAte = "ate_yaw_m";
constexpr double kMinSuccessRate = 0.5;
constexpr double kMaxGrowth = 2.0;  ///< of the ATE from the mildest level

/// Length of the route of a scenario [m].
double route_length(const Scenario& scenario) {
  const auto& points = scenario.simulation.route.points;
  double length = 0.0;
  for (std::size_t i = 1; i < points.size(); ++i) {
    length += std::hypot(points[i].x - points[i - 1].x, points[i].y - points[i - 1].y);
  }
  return length;
}

using Members = std::vector<const SuiteCase*>;

FamilyPoint point_of(const SuiteCase& each, const std::string& estimator) {
  FamilyPoint point;
  point.level = each.scenario.level;
  point.invalid = invalid_runs(each.runs).size();
  point.distance_m = route_length(each.scenario);
  const auto own = labels_of(each.scenario.run);
  if (std::find(own.begin(), own.end(), estimator) == own.end()) return point;
  point.ate_m = statistics_of(each.runs, estimator, kAte).median;
  point.ate_interval = median_interval(each.runs, estimator, kAte);
  point.m_list = statistics_of(each.runs, estimator, "m_list_percent.all").median;
  point.m_list_interval = median_interval(each.runs, estimator, "m_list_percent.all");
  const SuccessRate rate = success_rate(each.runs, estimator);
  point.runs = rate.runs;
  point.partial = any_partial(each.runs, estimator);
  if (point.runs == 0) return point;
  point.success_rate = static_cast<double>(rate.count) / static_cast<double>(rate.runs);
  point.success_interval = rate.interval();
  return point;
}

std::optional<double> equivalent_returns(const SuiteCase& each) {
  std::vector<double> values;
  for (const RunRecord& run : each.runs) {
    if (!is_valid_run(run)) continue;
    const Json sums = value_in(run.scores, "localizability", Json());
    const Json value = value_in(sums, "median_equivalent_returns", Json());
    if (value.is_number()) values.push_back(value.get<double>());
  }
  return median(values);
}

/// Index of the mildest level; see `family_results`.
std::size_t mildest_of(const std::vector<FamilyCurve>& curves, std::size_t levels) {
  std::size_t mildest = 0;
  std::pair<double, double> best = {-1.0, 0.0};
  for (std::size_t i = 0; i < levels; ++i) {
    double rate = 0.0;
    double log_ate = 0.0;
    for (const FamilyCurve& curve : curves) {
      const FamilyPoint& point = curve.points[i];
      rate += point.success_rate;
      const double none = std::numeric_limits<double>::max();
      log_ate += std::log(std::max(point.ate_m.value_or(none), 1e-9));
    }
    const std::pair<double, double> merit = {rate, -log_ate};
    if (merit > best) {
      best = merit;
      mildest = i;
    }
  }
  return mildest;
}

/// What changes per seed from one level to another, over all estimators that have both.
struct LevelChanges {
  std::vector<double> successes;  ///< less of them
  std::vector<double> log_ate;    ///< mean growth
};

LevelChanges changes_between(const SuiteCase& from, const SuiteCase& to,
                             const std::vector<std::string>& estimators) {
  LevelChanges changes;
  for (const RunRecord& a : from.runs) {
    const auto b = std::ranges::find(to.runs, a.seed, &RunRecord::seed);
    if (b == to.runs.end() || !is_valid_run(a) || !is_valid_run(*b)) continue;
    double lost = 0.0;
    std::vector<double> growths;
    for (const std::string& name : estimators) {
      const auto before = succeeds(a, name);
      const auto after = succeeds(*b, name);
      if (before && after) lost += double(*before) - double(*after);
      const ScorePairs ate = paired({{&a, 1}, name}, {{&*b, 1}, name}, kAte);
      if (ate.value.empty() || !(ate.value[0] > 0.0) || !(ate.reference[0] > 0.0)) continue;
      growths.push_back(std::log(ate.value[0] / ate.reference[0]));
    }
    changes.successes.push_back(lost);
    if (!growths.empty()) changes.log_ate.push_back(*mean(growths));
  }
  return changes;
}

/// Levels that the seeds do not tell apart from the mildest; see `family_results`.
std::optional<std::vector<double>> alike_with(const SuiteCase& mildest, const Members& members,
                                              const std::vector<std::string>& estimators) {
  std::vector<double> alike;
  for (const SuiteCase* each : members) {
    if (each == &mildest) continue;
    const LevelChanges changes = changes_between(mildest, *each, estimators);
    if (changes.successes.size() < kFewestPairs) return std::nullopt;
    const bool differs =
        paired_test(changes.successes).found() || paired_test(changes.log_ate).found();
    if (!differs) alike.push_back(each->scenario.level);
  }
  return alike;
}

bool broken(const FamilyPoint& point, const FamilyPoint& mildest) {
  if (point.runs == 0) return false;
  if (point.success_rate < kMinSuccessRate || !point.ate_m) return true;
  return mildest.ate_m && *point.ate_m > kMaxGrowth * *mildest.ate_m &&
         *point.ate_m > kMinBreakError * point.distance_m;
}

std::vector<double> breaks_of(const std::vector<FamilyPoint>& points, std::size_t mildest) {
  if (broken(points[mildest], points[mildest])) return {points[mildest].level};
  std::vector<double> breaks;
  for (std::size_t i = mildest; i-- > 0;) {
    if (!broken(points[i], points[mildest])) continue;
    breaks.push_back(points[i].level);
    break;
  }
  for (std::size_t i = mildest + 1; i < points.size(); ++i) {
    if (!broken(points[i], points[mildest])) continue;
    breaks.push_back(points[i].level);
    break;
  }
  return breaks;
}

FamilyResult family_of(const std::string& name, const Members& members,
                       const std::vector<std::string>& estimators) {
  FamilyResult family;
  family.name = name;
  family.level_unit = members.front()->scenario.level_unit;
  for (const SuiteCase* each : members) {
    family.equivalent_returns.push_back(equivalent_returns(*each));
  }
  for (const std::string& estimator : estimators) {
    FamilyCurve curve;
    curve.estimator = estimator;
    for (const SuiteCase* each : members) curve.points.push_back(point_of(*each, estimator));
    family.curves.push_back(std::move(curve));
  }
  const std::size_t mildest = mildest_of(family.curves, members.size());
  family.mildest = members[mildest]->scenario.level;
  family.alike = alike_with(*members[mildest], members, estimators);
  for (FamilyCurve& curve : family.curves) curve.breaks_at = breaks_of(curve.points, mildest);
  return family;
}

Json point_json(const FamilyPoint& point) {
  return {{"level", point.level},
          {"ate_yaw_m", json_of(point.ate_m)},
          {"ate_yaw_low_m", json_of(point.ate_interval.low)},
          {"ate_yaw_high_m", json_of(point.ate_interval.high)},
          {"m_list_percent", json_of(point.m_list)},
          {"m_list_low_percent", json_of(point.m_list_interval.low)},
          {"m_list_high_percent", json_of(point.m_list_interval.high)},
          {"success_rate", point.success_rate},
          {"success_low", json_of(point.success_interval.low)},
          {"success_high", json_of(point.success_interval.high)},
          {"runs", point.runs},
          {"invalid", point.invalid},
          {"partial", point.partial}};
}

}  // namespace

std::vector<FamilyResult> family_results(const Suite& suite) {
  std::map<std::string, Members> members;
  for (const SuiteCase& each : suite.cases) {
    if (!each.scenario.family.empty() && !each.runs.empty()) {
      members[each.scenario.family].push_back(&each);
    }
  }
  std::vector<FamilyResult> families;
  for (auto& [name, cases] : members) {
    if (cases.size() < 2) continue;
    std::stable_sort(cases.begin(), cases.end(), [](const SuiteCase* a, const SuiteCase* b) {
      return a->scenario.level < b->scenario.level;
    });
    families.push_back(family_of(name, cases, estimators_of(suite)));
  }
  return families;
}

std::string alike_text(const FamilyResult& family) {
  if (!family.alike) return fmt::format("fewer than {} seeds", kFewestPairs);
  if (family.alike->empty()) return "-";
  return fmt::format("{:g}", fmt::join(*family.alike, ", "));
}

Json families_json(const std::vector<FamilyResult>& families) {
  return json_array(families, [](const FamilyResult& family) {
    Json curves = Json::object();
    for (const FamilyCurve& curve : family.curves) {
      curves[curve.estimator] = {{"breaks_at", curve.breaks_at},
                                 {"points", json_array(curve.points, point_json)}};
    }
    return Json{{"name", family.name},
                {"level_unit", family.level_unit},
                {"mildest_level", family.mildest},
                {"alike_levels", family.alike ? Json(*family.alike) : Json()},
                {"median_equivalent_returns",
                 json_array(family.equivalent_returns, [](auto value) { return json_of(value); })},
                {"estimators", std::move(curves)}};
  });
}

}  // namespace aims
