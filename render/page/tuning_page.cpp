// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <map>
#include <numeric>
#include <optional>
#include <set>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "bench/scenario/scenario.hpp"
#include "bench/scoring/json_text.hpp"
#include "bench/scoring/score_record.hpp"
#include "bench/scoring/score_statistics.hpp"
#include "bench/scoring/validity.hpp"
#include "bench/studies/suite_summary.hpp"
#include "bench/tuning/range_key.hpp"
#include "bench/tuning/sweep_summary.hpp"
#include "bench/tuning/tune_summary.hpp"
#include "bench/tuning/tune_verdict.hpp"
#include "render/page/links.hpp"
#include "render/page/pages.hpp"
#include "render/page/series.hpp"
#include "render/page/tuning_analyses.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t kMostNumbers = 400'000;  ///< scores of all rows

/// A job with its place among points and sequences.
struct Row {
  std::size_t point = 0;
  std::size_t sequence = 0;
  bool held_out = false;
  JobResult result;
};

/// The jobs of one estimator.
struct EstimatorRows {
  EstimatorSpec estimator;
  std::vector<std::vector<double>> points;           ///< an empty one: the untuned values
  std::map<std::vector<double>, std::size_t> index;  ///< of each point
  std::vector<Row> rows;
};

/// All jobs by estimator, with the sequences that they use.
struct Collected {
  std::vector<EstimatorRows> estimators;
  std::vector<ResponseCase> sequences;
};

/// Index of what `same` recognizes; `value` is added when nothing is.
template <class Value, class Same>
std::size_t index_in(std::vector<Value>& values, const Same& same, Value value) {
  const auto found = std::find_if(values.begin(), values.end(), same);
  if (found != values.end()) return static_cast<std::size_t>(found - values.begin());
  values.push_back(std::move(value));
  return values.size() - 1;
}

void collect(const MergedSweep& units, const VariedParameters& varied, bool held_out,
             Collected& all) {
  for (const MergedJob& unit : units.jobs) {
    auto placed = placed_job(unit, varied);
    if (!placed) continue;
    const std::string name = text_of(placed->estimator);
    const std::size_t e =
        index_in(all.estimators, [&](const auto& each) { return text_of(each.estimator) == name; },
                 {placed->estimator, {}, {}, {}});
    EstimatorRows& own = all.estimators[e];
    Row row;
    row.point = own.index.emplace(placed->values, own.points.size()).first->second;
    if (row.point == own.points.size()) own.points.push_back(placed->values);
    row.sequence = index_in(
        all.sequences,
        [&](const auto& each) {
          return each.scenario == placed->on.scenario && each.seed == placed->on.seed;
        },
        placed->on);
    row.held_out = held_out;
    row.result = std::move(placed->result);
    own.rows.push_back(std::move(row));
  }
}

/// Numbers the points: the defaults are 0, those of a tuning follow in the order of its search.
void number_points(const TuningSource& source, const VariedParameters& varied, EstimatorRows& own) {
  const auto defaults = default_values(own.estimator, varied);
  const auto place = [&](std::size_t i) {
    const std::vector<double>& point = own.points[i];
    if (point.empty() || (defaults && point == *defaults)) return std::pair(0, std::size_t{0});
    const auto found = source.points.find(point);
    const bool known = found != source.points.end();
    return std::pair(known ? 1 : 2, known ? found->second.index : i);
  };
  std::vector<std::size_t> order(own.points.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::sort(order, {}, place);
  std::vector<std::vector<double>> points;
  std::vector<std::size_t> number(order.size());
  for (const std::size_t i : order) {
    number[i] = points.size();
    points.push_back(own.points[i]);
  }
  own.points = std::move(points);
  for (Row& row : own.rows) row.point = number[row.point];
}

void add_keys(const Json& json, const std::string& prefix, std::vector<std::string>& keys) {
  for (const auto& [key, value] : json.items()) {
    if (value.is_object()) {
      add_keys(value, prefix + key + ".", keys);
    } else if (value.is_number() &&
               std::find(keys.begin(), keys.end(), prefix + key) == keys.end()) {
      keys.push_back(prefix + key);
    }
  }
}

/// Scores of the objectives, the headline scores, then all others as far as the page holds them.
std::vector<std::string> scores_of(const TuningSource& source, const Collected& all) {
  std::vector<std::string> keys;
  const auto add = [&](const std::string& key) {
    if (std::find(keys.begin(), keys.end(), key) == keys.end()) keys.push_back(key);
  };
  for (const Objective& each : source.objectives) add(each.score);
  for (const Score& each : headline_scores()) add(each.key);
  std::size_t rows = 1;
  for (const EstimatorRows& each : all.estimators) {
    rows += each.rows.size();
    for (const Row& row : each.rows) add_keys(row.result.scores, "", keys);
  }
  const std::size_t least = source.objectives.size() + kHeadlineCount;
  keys.resize(std::min(keys.size(), std::max(least, kMostNumbers / rows)));
  return keys;
}

Json parameters_json(const VariedParameters& varied, const std::vector<double>& defaults) {
  Scenario scenario;
  const Fields fields = fields_of(scenario);
  Json parameters = Json::array();
  for (std::size_t i = 0; i < varied.ranges.size(); ++i) {
    const ParameterRange& range = varied.ranges[i];
    const auto found = fields.matching(full_key(range));
    const Parameter* parameter = found.empty() ? nullptr : found.front();
    parameters.push_back({{"name", range.key},
                          {"unit", parameter == nullptr ? "" : parameter->spec.unit},
                          {"meaning", parameter == nullptr ? "" : parameter->spec.meaning},
                          {"low", range.low},
                          {"high", range.high},
                          {"log", range.log},
                          {"default", defaults[i]}});
  }
  return parameters;
}

/// Per point its values (the defaults for the untuned one) and its generation.
Json points_json(const EstimatorRows& own, const std::vector<double>& defaults,
                 const TuningSource& source, PageData& page) {
  std::vector<double> values;
  std::vector<double> generation;
  std::vector<std::uint8_t> untuned;
  for (const auto& point : own.points) {
    const auto& numbers = point.empty() ? defaults : point;
    values.insert(values.end(), numbers.begin(), numbers.end());
    untuned.push_back(point.empty() ? 1 : 0);
    const auto found = source.points.find(numbers);
    generation.push_back(found == source.points.end() ? kNone : found->second.generation);
  }
  return {{"values", page.f32(values)},
          {"untuned", page.u8(untuned)},
          {"generation", source.points.empty() ? Json() : page.f32(generation)}};
}

/// Beyond the values of JobOutcome: on an invalid run.
constexpr std::uint8_t kInvalidOutcome = 4;

/// The scores of a job by their dotted keys, each read once; none of a job that is not done, and
/// the success alone of an estimate that lacks a part of the run.
std::map<std::string, double> numbers_in(const JobResult& result) {
  std::map<std::string, double> numbers;
  if (result.outcome != JobOutcome::kDone || !result.scores.is_object()) return numbers;
  const bool partial = is_partial(result.scores);
  visit_leaves(result.scores, "", [&](const std::string& key, const Json& value) {
    if (partial && !key.starts_with(kSuccessKey)) return;
    if (value.is_number()) numbers.emplace(key, value.get<double>());
    if (value.is_boolean()) numbers.emplace(key, value.get<bool>() ? 1.0 : 0.0);
  });
  return numbers;
}

/// Per estimator, the scenarios and seeds on which its points are compared (`cases_of`).
using Compared = std::set<std::tuple<std::string, std::string, std::uint64_t>>;

Result<Compared> compared_in(const MergedSweep& units) {
  Compared compared;
  if (units.jobs.empty()) return compared;
  const auto responses = sweep_responses(units, kSuccessKey);
  if (!responses) return tl::unexpected(responses.error());
  for (const SweepResponse& each : *responses) {
    for (const std::size_t i : cases_of(each.table, "")) {
      const ResponseCase& on = each.table.cases[i];
      compared.emplace(each.estimator, on.scenario, on.seed);
    }
  }
  return compared;
}

/// The same of the sequences that are tuned on, and of those held out.
struct ComparedOf {
  Compared tuned;
  Compared held_out;
};

Json rows_json(const EstimatorRows& own, const std::vector<ResponseCase>& sequences,
               const ComparedOf& compared, const std::vector<std::string>& scores, PageData& page) {
  std::vector<double> point, sequence, values;
  std::vector<std::uint8_t> outcome, diverged, held_out, is_compared;
  const std::string name = text_of(own.estimator);
  for (const Row& row : own.rows) {
    point.push_back(static_cast<double>(row.point));
    sequence.push_back(static_cast<double>(row.sequence));
    const bool invalid = invalid_reason(row.result.sequence).has_value();
    outcome.push_back(invalid ? kInvalidOutcome : static_cast<std::uint8_t>(row.result.outcome));
    diverged.push_back(run_score(row.result, "success").diverged ? 1 : 0);
    held_out.push_back(row.held_out ? 1 : 0);
    const ResponseCase& on = sequences[row.sequence];
    const Compared& with = row.held_out ? compared.held_out : compared.tuned;
    is_compared.push_back(with.contains({name, on.scenario, on.seed}) ? 1 : 0);
    const auto known = invalid ? std::map<std::string, double>() : numbers_in(row.result);
    for (const std::string& key : scores) {
      const auto found = known.find(key);
      values.push_back(found == known.end() ? kNone : found->second);
    }
  }
  return {{"point", page.f32(point)},      {"sequence", page.f32(sequence)},
          {"outcome", page.u8(outcome)},   {"diverged", page.u8(diverged)},
          {"held_out", page.u8(held_out)}, {"compared", page.u8(is_compared)},
          {"scores", page.f32(values)}};
}

/// What was varied: "Sweep of degeneracy.eta and degeneracy.kappa".
std::string title_of(const TuningSource& source, const VariedParameters& varied) {
  std::vector<std::string> keys;
  for (const ParameterRange& each : varied.ranges) keys.push_back(each.key);
  return fmt::format("{} of {}", source.tuned ? "Tuning" : "Sweep", fmt::join(keys, ", "));
}

Json sequences_json(const std::vector<ResponseCase>& sequences) {
  return json_array(sequences, [](const ResponseCase& each) {
    return Json{{"scenario", each.scenario}, {"family", each.family}, {"seed", each.seed}};
  });
}

Json counts_json(const MergedSweep& units) {
  Json json = {{"total", units.jobs.size()}, {"others", units.others}};
  for (const char* outcome : {"done", "invalid", "failed", "crashed", "timed_out", "missing"}) {
    json[outcome] = units.count(outcome);
  }
  return json;
}

/// What a tuning came to, as it wrote it; null of a sweep and without results.
Json tune_in(const TuningSource& source, const fs::path& folder) {
  if (!source.tuned) return {};
  const auto text = read_file(folder / kTuneFile);
  auto json = text ? parse_json(*text, kTuneFile) : tl::unexpected(text.error());
  return json ? std::move(*json) : Json();
}

/// That held-out results were seen before the last ones; null: they were not.
Json looked_json(const fs::path& folder) {
  const std::size_t looks = looks_in(folder).size();
  return looks > 1 ? Json("Warning: " + looks_text(looks - 1) + ".") : Json();
}

Result<Json> estimators_json(const TuningSource& source, const VariedParameters& varied,
                             const Collected& all, const std::vector<std::string>& scores,
                             PageData& page) {
  auto tuned = compared_in(source.units);
  if (!tuned) return tl::unexpected(tuned.error());
  auto held_out = compared_in(source.held_out);
  if (!held_out) return tl::unexpected(held_out.error());
  const ComparedOf compared{std::move(*tuned), std::move(*held_out)};
  Json json = Json::array();
  for (const EstimatorRows& own : all.estimators) {
    const auto defaults = default_values(own.estimator, varied);
    if (!defaults) return tl::unexpected(defaults.error());
    auto analyses = analyses_json(source, text_of(own.estimator), own.points, page);
    if (!analyses) return analyses;
    json.push_back({{"name", text_of(own.estimator)},
                    {"parameters", parameters_json(varied, *defaults)},
                    {"points", points_json(own, *defaults, source, page)},
                    {"rows", rows_json(own, all.sequences, compared, scores, page)},
                    {"analyses", std::move(*analyses)}});
  }
  return json;
}

}  // namespace

Result<PageData> tuning_page(const fs::path& folder, const PageOptions& /*options*/) {
  if (auto ok = check_links(folder); !ok) return tl::unexpected(ok.error());
  const auto source = read_tuning(folder);
  if (!source) return tl::unexpected(source.error());
  return tuning_page(*source, folder);
}

Result<PageData> tuning_page(const TuningSource& source, const fs::path& folder) {
  const auto varied = varied_in(source.units);
  if (!varied) return failure(folder.string() + ": " + varied.error().message);
  Collected all;
  collect(source.units, *varied, false, all);
  const Json tune = tune_in(source, folder);
  // Some of the held-out runs decide nothing, and to see them would be a look.
  const bool interrupted = !value_in(tune, "complete", true);
  const MergedSweep none;
  const MergedSweep& held_out = interrupted ? none : source.held_out;
  collect(held_out, *varied, true, all);
  for (auto& each : all.estimators) number_points(source, *varied, each);
  const auto scores = scores_of(source, all);
  PageData page;
  page.title = title_of(source, *varied);
  auto estimators = estimators_json(source, *varied, all, scores, page);
  if (!estimators) return tl::unexpected(estimators.error());
  page.json = {{"schema", kPageSchema},
               {"kind", "tuning"},
               {"title", page.title},
               {"palette", palette_json()},
               {"source", source.tuned ? "tune" : "sweep"},
               {"plan", source.plan},
               {"jobs", counts_json(source.units)},
               {"looked", looked_json(folder)},
               {"front", source.objectives.size() > 1 ? value_in(tune, "verdict", Json()) : Json()},
               {"interrupted", interrupted},
               {"held_out_jobs", counts_json(held_out)},
               {"scores", scores},
               {"sequences", sequences_json(all.sequences)},
               {"estimators", std::move(*estimators)},
               {"notes", source.notes}};
  return page;
}

}  // namespace aims
