// SPDX-License-Identifier: BSD-3-Clause
#include "bench/estimate/estimate_log.hpp"

#include <algorithm>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "bench/metrics/success.hpp"
#include "bench/scoring/health_time.hpp"
#include "bench/scoring/score_record.hpp"
#include "bench/scoring/trajectory_summary.hpp"
#include "core/files/csv_columns.hpp"
#include "core/files/tum.hpp"

namespace aims {
Result<EstimateLog> EstimateLog::create(const std::filesystem::path& folder,
                                        const std::vector<TimedEstimator>& estimators,
                                        std::vector<std::vector<std::string>> warnings) {
  EstimateLog log(folder);
  log.warnings_ = std::move(warnings);
  log.warnings_.resize(estimators.size());
  log.totals_.resize(estimators.size());
  if (folder.empty()) return log;
  for (const TimedEstimator& each : estimators) {
    auto writer = RowWriter::create(folder, each.name());
    if (!writer) return tl::unexpected(writer.error());
    log.writers_.push_back(std::move(*writer));
  }
  return log;
}

Result<void> EstimateLog::take(std::vector<TimedEstimator>& estimators) {
  for (std::size_t i = 0; i < estimators.size(); ++i) {
    EstimatorRows rows = estimators[i].rows();
    add_rows(rows, totals_[i]);
    if (writers_.empty()) {
      estimators[i].pass();
      continue;
    }
    const std::vector<HealthRow> health = warned(rows.health, warnings_[i]);
    rows.health = health;
    if (auto written = writers_[i].add(rows); !written) return written;
    estimators[i].forget();
  }
  return {};
}

Result<void> EstimateLog::take(const Trajectory& truth) {
  if (truth.empty()) return {};
  if (!truth_) {
    auto file = AtomicFile::create(folder_ / kTruthFile);
    if (!file) return tl::unexpected(file.error());
    truth_.emplace(std::move(*file));
  }
  return truth_->write(tum_text(truth));
}

Result<void> EstimateLog::commit(const std::vector<TimedEstimator>& estimators) {
  for (std::size_t i = 0; i < writers_.size(); ++i) {
    if (estimators[i].estimator().result().failure && totals_[i].poses == 0) continue;
    if (auto done = writers_[i].commit(); !done) return done;
  }
  return truth_ ? truth_->commit() : Result<void>();
}

namespace {

/// State over time: of the file in the folder of the results, where there is one.
Result<std::vector<HealthRow>> health_rows(const EstimateResult& result,
                                           const EstimatorOutcome& outcome) {
  const auto file = result.folder / (outcome.name + ".health.csv");
  if (result.folder.empty() || !std::filesystem::exists(file)) return outcome.result.health;
  const auto table = CsvColumns::read(file);
  if (!table) return tl::unexpected(table.error());
  const auto stamps = table->numbers("stamp_s");
  if (!stamps) return tl::unexpected(stamps.error());
  const std::vector<std::string> states = table->texts("state");
  std::vector<HealthRow> rows(std::min(stamps->size(), states.size()));
  for (std::size_t i = 0; i < rows.size(); ++i) {
    rows[i].stamp = from_seconds((*stamps)[i]);
    const bool healthy = states[i] == name_of(HealthState::kHealthy);
    rows[i].state = healthy ? HealthState::kHealthy : HealthState::kInvalid;
  }
  return rows;
}

}  // namespace

Result<void> add_healthy_while_wrong(EstimateResult& result) {
  if (!result.scores) return {};
  const RunRecord record = record_of(*result.scores);
  for (const EstimatorOutcome& each : result.estimators) {
    const Json& scores = estimator_in(record, each.name);
    const auto wrong_from = number_at(scores, "diverged_at_s");
    if (!wrong_from || each.totals.health.healthy_s == 0.0) continue;
    if (value_in(scores, "diverged_reason", "") != name_of(FailureReason::kErrorLimit)) continue;
    const auto rows = health_rows(result, each);
    if (!rows) return tl::unexpected(rows.error());
    result.healthy_while_wrong_s[each.name] = healthy_after(*rows, from_seconds(*wrong_from));
  }
  return {};
}

}  // namespace aims
