// SPDX-License-Identifier: BSD-3-Clause
#include "bench/estimate/estimate_log.hpp"

#include <utility>

#include "bench/scoring/health_time.hpp"
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

}  // namespace aims
