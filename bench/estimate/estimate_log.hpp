// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "bench/estimate/estimate.hpp"
#include "bench/scoring/result_files.hpp"
#include "bench/scoring/timed_estimator.hpp"
#include "core/error.hpp"
#include "core/files/atomic_file.hpp"
#include "core/trajectory.hpp"

namespace aims {

/// Name of the file of the true poses of the body.
inline constexpr const char* kTruthFile = "truth.tum";

/// Takes the rows of estimators and the truth while a recording is read: sums them up and, where
/// there is a folder, writes them.
class EstimateLog {
 public:
  /// An empty folder: nothing is written. `warnings`: for each estimator, reasons that every
  /// row of its NAME.health.csv states, which is then degraded at best; the totals are without
  /// them. None: no reasons.
  static Result<EstimateLog> create(const std::filesystem::path& folder,
                                    const std::vector<TimedEstimator>& estimators,
                                    std::vector<std::vector<std::string>> warnings = {});

  /// Takes the rows since the last call, of the same estimators. Error when they cannot be written.
  Result<void> take(std::vector<TimedEstimator>& estimators);
  Result<void> take(const Trajectory& truth);
  /// Completes the files but of those that broke without a pose, which get none.
  Result<void> commit(const std::vector<TimedEstimator>& estimators);

  const EstimatorTotals& totals(std::size_t estimator) const { return totals_[estimator]; }

 private:
  explicit EstimateLog(std::filesystem::path folder) : folder_(std::move(folder)) {}

  std::filesystem::path folder_;
  std::vector<std::vector<std::string>> warnings_;  ///< by estimator
  std::vector<EstimatorTotals> totals_;
  std::vector<RowWriter> writers_;  ///< one per estimator; none without a folder
  std::optional<AtomicFile> truth_;
};

/// Fills in how long each scored estimator called itself healthy after its error exceeded the limit
/// of a success. Error when the file of its health cannot be read.
Result<void> add_healthy_while_wrong(EstimateResult& result);

}  // namespace aims
