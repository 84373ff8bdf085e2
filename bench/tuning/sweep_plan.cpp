// SPDX-License-Identifier: BSD-3-Clause
#include "bench/tuning/sweep_plan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <memory>
#include <set>
#include <system_error>
#include <utility>

#include "bench/jobs/job_id.hpp"
#include "bench/scenario/catalogue.hpp"
#include "bench/scenario/seeds.hpp"
#include "bench/tuning/range_key.hpp"
#include "bench/tuning/scenario_variants.hpp"
#include "core/files/atomic_file.hpp"
#include "core/files/config_dump.hpp"
#include "core/files/yaml_config.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;

constexpr const char* kObjectiveFile = "objective.yaml";

using Scenarios = std::vector<std::shared_ptr<const Scenario>>;

Result<void> add_scenario(Result<Scenario> scenario, Scenarios& scenarios) {
  if (!scenario) return tl::unexpected(scenario.error());
  for (const auto& known : scenarios) {
    if (known->name != scenario->name) continue;
    return failure(fmt::format("{} and {}: two scenarios of the name '{}'", known->file.string(),
                               scenario->file.string(), scenario->name));
  }
  scenarios.push_back(std::make_shared<const Scenario>(std::move(*scenario)));
  return {};
}

Result<std::vector<EstimatorSpec>> estimators_of(const SweepPlan& plan) {
  if (plan.estimators.empty()) return failure("estimators: the plan names none, e.g. [aims]");
  if (auto specs = check_estimator_specs(plan.estimators); !specs) {
    return failure("estimators: " + specs.error().message);
  }
  std::vector<EstimatorSpec> estimators;
  for (const std::string& text : plan.estimators) {
    estimators.push_back(*parse_estimator_spec(text));
  }
  return estimators;
}

/// An estimator at a point of the design, and the scenario there.
struct PlannedPoint {
  EstimatorSpec estimator;
  ScenarioVariant variant;
};

/// The estimators at their default setting and at every point of the design.
Result<std::vector<PlannedPoint>> points_of(const SweepPlan& plan,
                                            std::span<const ParameterRange> ranges,
                                            const std::shared_ptr<const Scenario>& scenario) {
  const auto estimators = estimators_of(plan);
  if (!estimators) return tl::unexpected(estimators.error());
  ScenarioVariants variants(scenario, ranges);
  std::vector<std::vector<double>> points;
  if (!ranges.empty()) {
    if (auto right = check_ranges(ranges, *scenario, *estimators); !right) {
      return tl::unexpected(right.error());
    }
    const auto size = design_size(plan.design, ranges, plan.samples);
    if (!size) return tl::unexpected(size.error());
    points =
        design(plan.design, ranges, plan.samples, static_cast<std::uint64_t>(plan.design_seed));
  }
  std::vector<PlannedPoint> planned;
  planned.reserve(estimators->size() * (points.size() + 1));
  for (const EstimatorSpec& estimator : *estimators) {
    planned.push_back({estimator, variants.untouched()});
    for (const auto& point : points) {
      auto variant = variants.at(point);
      if (!variant) return tl::unexpected(variant.error());
      auto spec = spec_at(estimator, ranges, point, scenario->estimators);
      planned.push_back({std::move(spec), std::move(*variant)});
    }
  }
  return planned;
}

/// Points on the same sequences, with the part of their jobs' ids that does not depend on the seed.
struct SequenceGroup {
  struct Member {
    const PlannedPoint* point = nullptr;
    const JobIds* ids = nullptr;
    std::string key;
  };
  std::vector<Member> members;
};

/// The scenarios of one group as a seed draws them, each made once.
class DrawnScenarios {
 public:
  explicit DrawnScenarios(std::uint64_t seed) : seed_(seed) {}

  /// The scenario on the seed, and the ids of its jobs; without draws itself, and no ids.
  std::pair<std::shared_ptr<const Scenario>, const JobIds*> find(
      const std::shared_ptr<const Scenario>& scenario) {
    if (scenario->draw.empty()) return {scenario, nullptr};
    auto [made, is_new] = made_.try_emplace(scenario.get());
    if (is_new) {
      made->second.first = scenario_of_seed(scenario, seed_);
      made->second.second = std::make_unique<const JobIds>(*made->second.first);
    }
    return {made->second.first, made->second.second.get()};
  }

 private:
  using Made = std::pair<std::shared_ptr<const Scenario>, std::unique_ptr<const JobIds>>;

  std::uint64_t seed_;
  std::map<const Scenario*, Made> made_;
};

/// Adds one scenario's jobs but those whose ids are known already.
Result<void> add_jobs(std::span<const std::uint64_t> seeds, std::span<const PlannedPoint> points,
                      std::set<std::string>& known, std::vector<Job>& jobs) {
  std::map<const Scenario*, JobIds> ids;
  std::map<std::string, std::size_t> index;
  std::vector<SequenceGroup> groups;
  for (const PlannedPoint& point : points) {
    const Scenario& scenario = *point.variant.scenario;
    const JobIds& own = ids.try_emplace(&scenario, scenario).first->second;
    auto key = own.estimator_key(point.estimator);
    if (!key) return tl::unexpected(key.error());
    const auto [at, is_new] = index.emplace(point.variant.sequence, groups.size());
    if (is_new) groups.emplace_back();
    groups[at->second].members.push_back({&point, &own, std::move(*key)});
  }
  for (const SequenceGroup& group : groups) {
    for (const std::uint64_t seed : seeds) {
      DrawnScenarios drawn(seed);
      for (const auto& [point, own, key] : group.members) {
        const auto& scenario = point->variant.scenario;
        auto [on_seed, drawn_ids] = drawn.find(scenario);
        std::string id = (drawn_ids == nullptr ? own : drawn_ids)->id(seed, key);
        if (!known.insert(id).second) continue;
        jobs.push_back({on_seed, seed, point->estimator, std::move(id), point->variant.settings,
                        own->version(key)});
      }
    }
  }
  return {};
}

}  // namespace

void describe(Fields& f, SweepPlan& p) {
  f.texts("scenarios", p.scenarios, {.meaning = "scenario files or names"});
  f.texts("tags", p.tags, {.meaning = "with them, all scenarios with any of these tags"});
  f.text("seeds", p.seeds, {.meaning = "of every scenario: 3, 1-5 or 1,4,7-9"});
  f.texts("estimators", p.estimators, {.meaning = "NAME or LABEL=NAME+key=value"});
  f.texts("params", p.params,
          {.meaning = "parameters that vary, any number of `aims config`: KEY=LOW:HIGH:COUNT or "
                      "KEY=log(LOW,HIGH,COUNT)"});
  f.texts("set", p.set, {.meaning = "key=value on top of every scenario"});
  f.choice("design", p.design,
           {{"grid", DesignKind::kGrid},
            {"random", DesignKind::kRandom},
            {"sobol", DesignKind::kSobol},
            {"lhs", DesignKind::kLatinHypercube}},
           {.meaning = "how points are laid into the ranges"});
  f.integer(
      "samples", p.samples,
      {.unit = "-", .range = in_range(1, 1000000), .meaning = "points of every design but a grid"});
  f.integer("design_seed", p.design_seed,
            {.unit = "-", .range = in_range(0, 2147483647), .meaning = "of those points"});
  f.number("timeout", p.timeout,
           {.unit = "s", .range = up_to(1e7), .meaning = "wall time of a job; 0: any"});
}

Result<SweepPlan> load_plan(const fs::path& file) {
  SweepPlan plan;
  if (auto loaded = load_config(file, plan); !loaded) return tl::unexpected(loaded.error());
  resolve_scenarios(file, plan.scenarios);
  resolve_settings(file, plan.set);
  return plan;
}

std::string plan_text(const SweepPlan& plan) {
  SweepPlan copy = plan;
  return dump_config(fields_of(copy));
}

Result<void> write_objective(const Objective& objective, const fs::path& folder) {
  Objective copy = objective;
  return write_file_atomically(folder / kObjectiveFile, dump_config(fields_of(copy)));
}

Result<Objective> objective_in(const fs::path& folder) {
  Objective objective;
  std::error_code ignored;
  if (!fs::exists(folder / kObjectiveFile, ignored)) return objective;
  if (auto read = load_config(folder / kObjectiveFile, objective); !read) {
    return tl::unexpected(read.error());
  }
  return objective;
}

Result<Scenarios> plan_scenarios(std::span<const std::string> names,
                                 std::span<const std::string> tags,
                                 std::span<const std::string> settings, const fs::path& folder) {
  if (names.empty() && tags.empty()) {
    return failure(
        "no scenario is given, so that there is no job: expected scenarios or tags, e.g. "
        "scenarios: [corridor]");
  }
  auto files = select_scenarios(names, tags, folder, settings);
  if (!files) return tl::unexpected(files.error());
  Scenarios scenarios;
  for (ScenarioFile& each : *files) {
    auto added = add_scenario(std::move(each.scenario), scenarios);
    if (!added) return tl::unexpected(added.error());
  }
  return scenarios;
}

std::string fixed_text(EstimatorSpec spec, std::span<const ParameterRange> ranges) {
  std::erase_if(spec.settings, [&](const auto& setting) {
    return std::ranges::any_of(
        ranges, [&](const ParameterRange& range) { return range.key == setting.first; });
  });
  std::ranges::sort(spec.settings);
  return unlabelled_text(spec);
}

namespace {

/// The default of a range's key in a scenario, of the estimator where it is one of its keys; none
/// where that has no such key.
std::optional<std::string> default_text(const ParameterRange& range, const Scenario& scenario,
                                        const EstimatorSpec& estimator) {
  const auto text_in = [](const Fields& fields, const std::string& key) {
    const Parameter* parameter = fields.find(key);
    return parameter == nullptr ? std::nullopt : std::optional(parameter->text());
  };
  if (range.of_estimator) {
    const auto config = config_with(estimator, scenario.estimators);
    return config ? text_in(fields_of(**config), range.key) : std::nullopt;
  }
  Scenario copy = scenario;
  return text_in(fields_of(copy), full_key(range));
}

/// Error where the estimator has another default in a scenario than in the first one.
Result<void> check_same_default(std::span<const std::shared_ptr<const Scenario>> scenarios,
                                const ParameterRange& range, const EstimatorSpec& estimator) {
  const auto first = default_text(range, *scenarios.front(), estimator);
  for (const auto& scenario : scenarios.subspan(1)) {
    const auto other = default_text(range, *scenario, estimator);
    if (!first || !other || *first == *other) continue;
    const std::string key = range.of_estimator
                                ? fmt::format("estimators.{}.{}", estimator.name, range.key)
                                : full_key(range);
    return failure(fmt::format(
        "{}: {} is {} there and {} in {}; expected the same default values in all scenarios, e.g. "
        "by --set {}={}",
        scenario->name, range.key, *other, *first, scenarios.front()->name, key, *first));
  }
  return {};
}

}  // namespace

Result<void> check_same_defaults(std::span<const std::shared_ptr<const Scenario>> scenarios,
                                 std::span<const ParameterRange> ranges,
                                 std::span<const EstimatorSpec> estimators) {
  for (const ParameterRange& range : ranges) {
    for (const EstimatorSpec& estimator : estimators) {
      if (auto same = check_same_default(scenarios, range, estimator); !same) return same;
    }
  }
  return {};
}

namespace {

/// Error for two estimators that differ in nothing but what is varied: their points are the same.
Result<void> check_different(const std::vector<EstimatorSpec>& estimators,
                             std::span<const ParameterRange> ranges) {
  std::map<std::string, std::string> known;
  for (const EstimatorSpec& spec : estimators) {
    const auto [same, is_new] = known.emplace(fixed_text(spec, ranges), spec.label);
    if (is_new) continue;
    return failure(fmt::format(
        "estimators: {} and {} differ in nothing but what is varied, so that they are the same at "
        "every point; expected one of them",
        same->second, spec.label));
  }
  return {};
}

}  // namespace

Result<void> set_estimators(const SweepPlan& plan, EstimatorConfigs& configs) {
  if (auto added = add_python_estimators(plan.estimators, configs); !added) return added;
  Fields fields;
  describe_estimators(fields, plan.estimators, configs);
  for (const std::string& setting : plan.set) {
    if (!setting.starts_with("estimators.")) continue;
    const auto equals = setting.find('=');
    auto done = assign(fields, setting.substr(0, equals), setting.substr(equals + 1));
    if (!done) return done;
  }
  return {};
}

Result<std::vector<Job>> plan_jobs(const SweepPlan& plan, const fs::path& folder) {
  const auto estimators = estimators_of(plan);
  if (!estimators) return tl::unexpected(estimators.error());
  std::vector<std::string> settings = plan.set;
  settings.push_back(run_setting(plan.estimators));
  const auto scenarios = plan_scenarios(plan.scenarios, plan.tags, settings, folder);
  if (!scenarios) return tl::unexpected(scenarios.error());
  const auto seeds = parse_seeds(plan.seeds);
  if (!seeds) return tl::unexpected(seeds.error());
  const auto ranges = parse_ranges(plan.params, plan.estimators);
  if (!ranges) return tl::unexpected(ranges.error());
  if (auto different = check_different(*estimators, *ranges); !different) {
    return tl::unexpected(different.error());
  }
  if (auto same = check_same_defaults(*scenarios, *ranges, *estimators); !same) {
    return tl::unexpected(same.error());
  }
  // Reports take the defaults of an estimator from the program and the plan.
  auto plain = std::make_shared<Scenario>(*scenarios->front());
  plain->name = "the program";
  plain->estimators = {};
  if (auto set = set_estimators(plan, plain->estimators); !set) return tl::unexpected(set.error());
  const Scenarios compared = {std::move(plain), scenarios->front()};
  if (auto same = check_same_defaults(compared, *ranges, *estimators); !same) {
    return tl::unexpected(same.error());
  }
  std::vector<Job> jobs;
  std::set<std::string> ids;
  for (const auto& scenario : *scenarios) {
    if (auto right = check_seeds_to_choose_on(*scenario, *seeds); !right) {
      return tl::unexpected(right.error());
    }
    const auto points = points_of(plan, *ranges, scenario);
    if (!points) return tl::unexpected(points.error());
    auto added = add_jobs(*seeds, *points, ids, jobs);
    if (!added) return tl::unexpected(added.error());
  }
  return jobs;
}

namespace {

std::string resolved(const fs::path& plan, const std::string& given) {
  std::error_code ignored;
  const fs::path beside = plan.parent_path() / given;
  return fs::is_regular_file(beside, ignored) ? beside.string() : given;
}

}  // namespace

void resolve_scenarios(const fs::path& plan, std::vector<std::string>& scenarios) {
  for (std::string& each : scenarios) each = resolved(plan, each);
}

void resolve_settings(const fs::path& plan, std::vector<std::string>& settings) {
  for (std::string& each : settings) {
    if (each.starts_with('@')) each = "@" + resolved(plan, each.substr(1));
  }
}

}  // namespace aims
