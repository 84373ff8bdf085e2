// SPDX-License-Identifier: BSD-3-Clause
#include "bench/studies/drawn_groups.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <span>

#include "bench/scoring/report.hpp"
#include "bench/scoring/validity.hpp"
#include "bench/studies/success_columns.hpp"
#include "core/config.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kGroupsSchema = "aims.groups/1";

/// The drawn value of a run; null when it drew no such key.
Json drawn_in(const RunRecord& run, const std::string& key) {
  const auto drawn = run.scores.find("drawn");
  if (drawn == run.scores.end() || !drawn->is_object()) return {};
  return drawn->value(key, Json());
}

std::string text_of(const Json& value) {
  if (value.is_number()) return fmt::format("{:.4g}", value.get<double>());
  return value.is_string() ? value.get<std::string>() : value.dump();
}

GroupScores scores_of(std::span<const RunRecord> runs, const std::string& estimator) {
  GroupScores scores;
  scores.estimator = estimator;
  const SuccessRate rate = success_rate(runs, estimator);
  scores.runs = rate.runs;
  scores.successes = rate.count;
  scores.failed = failed_runs(runs, estimator);
  scores.partial = any_partial(runs, estimator);
  scores.strict = success_rate(runs, estimator, kStrictSuccessKey);
  for (const Score& score : headline_scores()) {
    scores.medians.push_back(statistics_of(runs, estimator, score.key).median);
  }
  return scores;
}

DrawnGroup group_of(const std::string& scenario, std::string label,
                    std::span<const RunRecord> runs) {
  DrawnGroup group;
  group.scenario = scenario;
  group.label = std::move(label);
  group.invalid = invalid_runs(runs).size();
  std::vector<std::string> estimators = estimators_in(runs);
  std::ranges::sort(estimators);
  for (const std::string& name : estimators) group.estimators.push_back(scores_of(runs, name));
  return group;
}

/// A group per text, in their order.
void add_texts(const std::string& scenario, const std::vector<RunRecord>& runs,
               const std::string& key, std::vector<DrawnGroup>& groups) {
  std::map<std::string, std::vector<RunRecord>> by_text;
  for (const RunRecord& run : runs) by_text[text_of(drawn_in(run, key))].push_back(run);
  for (const auto& [text, members] : by_text) groups.push_back(group_of(scenario, text, members));
}

void add_bins(const std::string& scenario, const std::vector<RunRecord>& runs,
              const std::string& key, std::size_t bins, std::vector<DrawnGroup>& groups) {
  std::vector<double> values;
  for (const RunRecord& run : runs) values.push_back(drawn_in(run, key).get<double>());
  const std::vector<double> ends = upper_ends(values, bins);
  std::vector<std::vector<RunRecord>> members(ends.size());
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const auto end = std::lower_bound(ends.begin(), ends.end(), values[i]);
    members[static_cast<std::size_t>(end - ends.begin())].push_back(runs[i]);
  }
  for (const auto& bin : members) {
    const auto value = [&key](const RunRecord& run) { return drawn_in(run, key).get<double>(); };
    const auto [low, high] = std::ranges::minmax(bin, {}, value);
    const double least = value(low);
    const double most = value(high);
    groups.push_back(group_of(
        scenario,
        least == most ? fmt::format("{:.4g}", least) : fmt::format("{:.4g} to {:.4g}", least, most),
        bin));
    groups.back().low = least;
    groups.back().high = most;
  }
}

/// One estimator in one group.
struct GroupRow {
  DrawnGroup group;
  GroupScores scores;
};

std::vector<GroupRow> rows_of(const std::vector<DrawnGroup>& groups) {
  std::vector<GroupRow> rows;
  for (const DrawnGroup& group : groups) {
    for (const GroupScores& each : group.estimators) rows.push_back({group, each});
  }
  return rows;
}

std::string success_text(const GroupScores& scores) {
  const std::string text = SuccessRate{scores.successes, scores.runs}.text();
  return scores.failed > 0 ? fmt::format("{}, {} failed", text, scores.failed) : text;
}

TableColumns<GroupRow> group_columns() {
  using Row = GroupRow;
  TableColumns<Row> columns = {
      {"scenario", "scenario", [](const Row& row) { return row.group.scenario; }},
      {"group", "group", [](const Row& row) { return row.group.label; }},
      {"low", "", [](const Row& row) { return row.group.low; }},
      {"high", "", [](const Row& row) { return row.group.high; }},
      {"estimator", "estimator", [](const Row& row) { return row.scores.estimator; }},
      {"runs", "", [](const Row& row) { return row.scores.runs; }},
      {"successes", "", [](const Row& row) { return row.scores.successes; }},
      {"", std::string(success_scores()[0].title),
       [](const Row& row) { return success_text(row.scores); }},
      {"", std::string(success_scores()[1].title),
       [](const Row& row) { return row.scores.strict.text(); }},
      {"successes_1_percent", "", [](const Row& row) { return row.scores.strict.count; }},
      {"failed", "", [](const Row& row) { return row.scores.failed; }},
      {"partial", "", [](const Row& row) { return row.scores.partial ? 1 : 0; }},
      {"invalid", "", [](const Row& row) { return row.group.invalid; }}};
  for (std::size_t i = 0; i < kHeadlineCount; ++i) {
    const Score& score = headline_scores()[i];
    columns.push_back({std::string(score.key) + ".median", "",
                       [i](const Row& row) { return row.scores.medians[i]; }});
    columns.push_back({"", title_with_unit(score), [i, digits = score.digits](const Row& row) {
                         const auto& median = row.scores.medians[i];
                         return number_text(median, fmt::format("{{:.{}f}}", digits)) +
                                part_mark(median && row.scores.partial);
                       }});
  }
  return columns;
}

/// Error that names the keys that the runs have drawn.
tl::unexpected<Error> no_such_key(const StoredResults& results, const std::string& key) {
  std::set<std::string> known;
  for (const auto& [scenario, runs] : results) {
    for (const RunRecord& run : runs) {
      const auto drawn = run.scores.find("drawn");
      if (drawn == run.scores.end()) continue;
      for (const auto& [name, unused] : drawn->items()) known.insert(name);
    }
  }
  if (known.empty()) {
    return failure(
        fmt::format("{}: no run here drew any quantity; expected results of scenarios "
                    "with a draw list, e.g. random_corridor",
                    key));
  }
  const std::string near = near_match(key, {known.begin(), known.end()});
  return failure(fmt::format("{}: no run drew it; expected one of {}{}", key,
                             fmt::join(known, ", "),
                             near.empty() ? "" : fmt::format("; did you mean '{}'?", near)));
}

}  // namespace

std::vector<double> upper_ends(std::vector<double> values, std::size_t bins) {
  std::sort(values.begin(), values.end());
  std::set<double> different(values.begin(), values.end());
  if (different.size() <= bins) return {different.begin(), different.end()};
  std::set<double> ends;
  for (std::size_t i = 1; i <= bins; ++i) ends.insert(values[i * values.size() / bins - 1]);
  return {ends.begin(), ends.end()};
}

Result<std::vector<DrawnGroup>> group_by_drawn(const StoredResults& results, const std::string& key,
                                               std::size_t bins) {
  std::vector<DrawnGroup> groups;
  for (const auto& [scenario, all] : results) {
    std::vector<RunRecord> runs;
    for (const RunRecord& run : all) {
      if (!drawn_in(run, key).is_null()) runs.push_back(run);
    }
    if (runs.empty()) continue;
    const bool numbers = std::ranges::all_of(
        runs, [&key](const RunRecord& run) { return drawn_in(run, key).is_number(); });
    if (numbers) {
      add_bins(scenario, runs, key, bins, groups);
    } else {
      add_texts(scenario, runs, key, groups);
    }
  }
  if (groups.empty()) return no_such_key(results, key);
  return groups;
}

TextTable groups_table(const std::vector<DrawnGroup>& groups) {
  return rows_table(group_columns(), rows_of(groups));
}

std::string groups_legend(const std::vector<DrawnGroup>& groups) {
  const auto is_marked = [](const GroupScores& each) {
    return each.partial &&
           std::ranges::any_of(each.medians, [](const auto& median) { return median.has_value(); });
  };
  const bool any = std::ranges::any_of(groups, [&](const DrawnGroup& group) {
    return std::ranges::any_of(group.estimators, is_marked);
  });
  return any ? kPartLegend : "";
}

Json groups_json(const std::vector<DrawnGroup>& groups, const std::string& key,
                 const std::string& folder) {
  Json json = {
      {"schema", kGroupsSchema}, {"folder", folder}, {"by", key}, {"groups", Json::array()}};
  for (const DrawnGroup& group : groups) {
    Json estimators = Json::object();
    for (const GroupScores& each : group.estimators) {
      Json& entry = estimators[each.estimator] =
          success_json({each.successes, each.runs}, each.strict);
      entry["failed"] = each.failed;
      entry["partial"] = each.partial;
      entry["median"] = Json::object();
      for (std::size_t i = 0; i < kHeadlineCount; ++i) {
        entry["median"][std::string(headline_scores()[i].key)] = json_of(each.medians[i]);
      }
    }
    json["groups"].push_back({{"scenario", group.scenario},
                              {"group", group.label},
                              {"low", json_of(group.low)},
                              {"high", json_of(group.high)},
                              {"invalid", group.invalid},
                              {"estimators", std::move(estimators)}});
  }
  return json;
}

Result<void> write_groups(const std::vector<DrawnGroup>& groups, const std::string& key,
                          const std::string& source, const fs::path& folder) {
  std::string legend = groups_legend(groups);
  if (!legend.empty()) legend.insert(0, "\n");
  return write_report({.name = "groups",
                       .markdown = fmt::format("# {} by {}\n\n{}{}", source, key,
                                               to_markdown(groups_table(groups)), legend),
                       .csv = rows_csv(group_columns(), rows_of(groups)),
                       .json = groups_json(groups, key, source)},
                      folder);
}

}  // namespace aims
