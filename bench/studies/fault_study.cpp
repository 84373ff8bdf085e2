// SPDX-License-Identifier: BSD-3-Clause
#include "bench/studies/fault_study.hpp"

#include <fmt/format.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <mutex>
#include <set>

#include "bench/estimate/stream.hpp"
#include "bench/run/evaluate.hpp"
#include "bench/scoring/report.hpp"
#include "bench/scoring/score_statistics.hpp"

namespace aims {
namespace {

FaultWindow window_of(const Sequence& sequence) {
  const auto begin = from_seconds(kFaultBegin * to_seconds(sequence.end()));
  return {begin, begin + kFaultLength};
}

/// What the estimator came to on the stream with the fault.
Result<EstimatorOutcome> outcome_under(const StreamFault& fault, const std::string& spec,
                                       const Sequence& sequence, const Scenario& scenario,
                                       std::uint64_t seed) {
  auto estimators = make_estimators({&spec, 1}, scenario.estimators, sequence.reader.rig());
  if (!estimators) return tl::unexpected(estimators.error());
  TimedEstimator& estimator = estimators->front();
  FaultWindow window = window_of(sequence);
  if (fault.always) window.begin = 0;
  const FaultTransform transform = fault.make(window, seed);
  std::vector<Delivery> arriving;
  const auto replayed = sequence.reader.replay([&](const Delivery& delivery) {
    arriving.clear();
    transform(delivery, arriving);
    estimator.consume(arriving);
  });
  if (!replayed) return tl::unexpected(replayed.error());
  estimator.finish();
  EstimatorOutcome outcome = outcome_of(estimator);
  add_scores(sequence, scenario, outcome);
  return outcome;
}

bool is_alarm(const HealthRow& row) {
  return row.state == HealthState::kDegraded || row.state == HealthState::kInvalid;
}

/// Fraction of the time after the start in which the estimate is not called healthy.
double alarm_fraction(const std::vector<HealthRow>& rows) {
  Duration alarmed = 0;
  Duration all = 0;
  for (std::size_t i = 0; i + 1 < rows.size(); ++i) {
    if (rows[i].state == HealthState::kStarting) continue;
    const Duration span = rows[i + 1].stamp - rows[i].stamp;
    all += span;
    if (is_alarm(rows[i])) alarmed += span;
  }
  return all > 0 ? static_cast<double>(alarmed) / static_cast<double>(all) : 0.0;
}

/// Whether any row between `begin` and `end` is an alarm, or the one in force at `begin` is.
bool alarmed_between(const std::vector<HealthRow>& rows, Time begin, Time end) {
  bool in_force = false;
  for (const HealthRow& row : rows) {
    if (row.stamp > end) break;
    if (row.stamp <= begin) in_force = is_alarm(row);
    if (row.stamp > begin && is_alarm(row)) return true;
  }
  return in_force;
}

FaultCase case_of(const StreamFault& fault, const EstimatorOutcome& outcome, Time begin) {
  const std::vector<HealthRow>& rows = outcome.result.health;
  FaultCase result;
  result.fault = fault.name;
  result.estimator = outcome.name;
  result.success = outcome.scores.success;
  result.ate_m = outcome.scores.ate_m;
  result.partial = outcome.scores.partial;
  result.alarm_fraction = alarm_fraction(rows);
  result.judged = std::ranges::any_of(
      rows, [](const HealthRow& row) { return row.state != HealthState::kStarting; });
  if (outcome.result.failure) result.failure = outcome.result.failure->message;
  for (const HealthRow& row : rows) {
    result.worst = std::max(result.worst, row.state);
    if (result.first_alarm_s || row.stamp < begin || !is_alarm(row)) continue;
    result.first_alarm_s = to_seconds(row.stamp - begin);
    result.reasons = fmt::format("{}", fmt::join(row.reasons, "; "));
  }
  if (result.success) return result;
  const Time failed = outcome.scores.diverged_at.value_or(begin);
  result.silent = result.judged && result.failure.empty() &&
                  !alarmed_between(rows, begin, failed + kNoticeTime);
  return result;
}

Result<std::vector<StreamFault>> selected(const std::vector<std::string>& names) {
  std::vector<StreamFault> faults = stream_faults();
  if (names.empty()) return faults;
  std::set<std::string> whole;
  for (const StreamFault& fault : faults) whole.insert(fault.name);
  const auto matches = [&whole](const StreamFault& fault, const std::string& name) {
    return whole.contains(name) ? fault.name == name : fault.name.starts_with(name);
  };
  for (const std::string& name : names) {
    const bool found = std::ranges::any_of(faults, [&](const auto& f) { return matches(f, name); });
    if (!found) return failure(fmt::format("--faults: no fault begins with '{}'", name));
  }
  std::erase_if(faults, [&](const StreamFault& fault) {
    return std::ranges::none_of(names, [&](const auto& name) { return matches(fault, name); });
  });
  return faults;
}

std::string state_text(const FaultCase& each) {
  return std::string(each.judged ? name_of(each.worst) : "not judged");
}

std::string cell(const FaultCase& each) {
  std::string text = each.success ? "" : each.silent ? "SILENT " : "failed ";
  if (!each.failure.empty()) return text + "with an error";
  if (each.ate_m) text += fmt::format("{:.2f}{} ", *each.ate_m, part_mark(each.partial));
  return text + state_text(each);
}

}  // namespace

Result<std::vector<FaultCase>> fault_study(
    const Sequence& sequence, const Scenario& scenario, const FaultStudyOptions& options,
    const std::function<bool(std::size_t done, std::size_t all)>& observer) {
  const auto faults = selected(options.faults);
  if (!faults) return tl::unexpected(faults.error());
  const std::size_t estimators = options.estimators.size();
  std::vector<std::optional<FaultCase>> cases(faults->size() * estimators);
  std::optional<Error> error;
  std::mutex mutex;
  std::size_t done = 0;
  std::atomic<bool> stopped = false;
  tbb::task_arena(options.jobs).execute([&] {
    tbb::parallel_for(std::size_t{0}, cases.size(), [&](std::size_t i) {
      if (stopped) return;
      const StreamFault& fault = (*faults)[i / estimators];
      const auto outcome = outcome_under(fault, options.estimators[i % estimators], sequence,
                                         scenario, options.seed);
      const std::scoped_lock lock(mutex);
      if (outcome) {
        cases[i] = case_of(fault, *outcome, fault.always ? 0 : window_of(sequence).begin);
      } else {
        error = outcome.error();
        stopped = true;
      }
      if (!observer(++done, cases.size())) stopped = true;
    });
  });
  if (error) return tl::unexpected(*error);
  std::vector<FaultCase> finished;
  for (auto& each : cases) {
    if (each) finished.push_back(std::move(*each));
  }
  return finished;
}

TextTable fault_table(const std::vector<FaultCase>& cases) {
  TextTable table;
  table.header = {"fault"};
  for (const FaultCase& each : cases) {
    const auto column = std::ranges::find(table.header, each.estimator);
    if (column == table.header.end()) table.header.push_back(each.estimator);
  }
  for (const FaultCase& each : cases) {
    if (table.rows.empty() || table.rows.back().front() != each.fault) {
      table.rows.push_back({each.fault});
      table.rows.back().resize(table.header.size(), "-");
    }
    const auto column = std::ranges::find(table.header, each.estimator) - table.header.begin();
    table.rows.back()[static_cast<std::size_t>(column)] = cell(each);
  }
  return table;
}

Result<void> write_faults(const std::vector<FaultCase>& cases, const std::string& sequence,
                          const std::filesystem::path& folder) {
  using Case = FaultCase;
  static const TableColumns<Case> columns = {{"fault", "", &Case::fault},
                                             {"estimator", "", &Case::estimator},
                                             {"success", "", &Case::success},
                                             {"partial", "", &Case::partial},
                                             {"ate_m", "", &Case::ate_m},
                                             {"worst_state", "", state_text},
                                             {"first_alarm_s", "", &Case::first_alarm_s},
                                             {"reasons", "", &Case::reasons},
                                             {"alarm_fraction", "", &Case::alarm_fraction},
                                             {"silent", "", &Case::silent}};
  const auto silent = std::ranges::count_if(cases, &FaultCase::silent);
  const std::string text = fmt::format(
      "# Faults on {}\n\n{} of {} cases fail unnoticed (SILENT). Cells: ATE [m], aligned at the "
      "start "
      "(part: over the part of the run that has poses alone), and the worst state that the "
      "estimator reported.\n\n{}",
      sequence, silent, cases.size(), to_markdown(fault_table(cases)));
  return write_report({.name = "faults", .markdown = text, .csv = rows_csv(columns, cases)},
                      folder);
}

}  // namespace aims
