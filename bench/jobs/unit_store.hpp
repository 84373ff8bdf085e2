// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "bench/run/run.hpp"
#include "bench/run/score_record.hpp"
#include "core/error.hpp"

namespace aims {

/// What a suite's folder already has of one scenario and seed.
struct StoredUnits {
  std::optional<RunRecord> record;   ///< holds the estimators that need not run again, and no other
  std::vector<std::string> missing;  ///< of the scenario's estimators: specs of those that must run
  std::vector<std::string> notes;    ///< why something that is there must run again
};

/// The folder `runs/` of a suite: `SCENARIO/seed-N/scores.json`, one file per scenario and seed,
/// that carries the id of each estimator's job, and the spec of each that has a label. A file is
/// replaced whole, so that it is finished or is not there.
class UnitStore {
 public:
  /// With `series`, an estimator counts as finished only with its errors along the weak axis.
  explicit UnitStore(const std::filesystem::path& suite_folder, bool series = false);

  /// What is stored under the ids that the scenario's jobs have now. A file that cannot be read
  /// counts as not there.
  StoredUnits find(const Scenario& scenario, std::uint64_t seed) const;

  /// Stores a record that has all of the scenario's estimators.
  Result<void> put(const Scenario& scenario, RunRecord& record) const;

  std::filesystem::path folder_of(const std::string& scenario, std::uint64_t seed) const;

 private:
  std::filesystem::path folder_;
  bool series_ = false;
};

}  // namespace aims
