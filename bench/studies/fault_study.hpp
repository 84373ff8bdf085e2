// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "bench/run/sequence.hpp"
#include "bench/scenario/scenario.hpp"
#include "bench/studies/stream_faults.hpp"
#include "core/error.hpp"
#include "core/files/table.hpp"
#include "estimator/interface/health.hpp"

namespace aims {

/// Faults begin at this fraction of the sequence; those that pass last 10 s.
inline constexpr double kFaultBegin = 0.4;
inline constexpr Duration kFaultLength = 10 * kSecond;

/// Time that an estimator has to notice that it is wrong.
inline constexpr Duration kNoticeTime = 2 * kSecond;

/// One estimator on a sequence with one fault.
struct FaultCase {
  std::string fault;
  std::string estimator;  ///< its label
  bool success = false;   ///< held against the truth
  bool partial = false;   ///< poses are missing: the ATE is that of a part of the run
  std::optional<double> ate_m;
  HealthState worst = HealthState::kStarting;  ///< after the start
  std::optional<double> first_alarm_s;  ///< first row that is not healthy, since the fault began
  std::string reasons;                  ///< of that row
  double alarm_fraction = 0.0;          ///< of the time after the start in which it is not healthy
  std::string failure;  ///< why the estimator ended, e.g. an exception; empty: it did not
  bool judged = false;  ///< it reports its health
  /// It fails and is called healthy until `kNoticeTime` after its error passed the limit.
  bool silent = false;
};

struct FaultStudyOptions {
  std::vector<std::string> estimators;  ///< specs
  std::vector<std::string> faults;      ///< names, or the beginnings of names; empty: all
  std::uint64_t seed = 1;
  int jobs = 1;  ///< threads; the result does not depend on it
};

/// Runs every estimator on the sequence under every fault, by fault and estimator. Error for a
/// fault that does not exist, a spec or a sequence that cannot be read. `observer` is called with
/// the cases done and all; false ends the study early, with what is done.
Result<std::vector<FaultCase>> fault_study(
    const Sequence& sequence, const Scenario& scenario, const FaultStudyOptions& options,
    const std::function<bool(std::size_t done, std::size_t all)>& observer);

/// A row per fault: what each estimator came to.
TextTable fault_table(const std::vector<FaultCase>& cases);

/// Writes faults.csv and faults.md into `folder`.
Result<void> write_faults(const std::vector<FaultCase>& cases, const std::string& sequence,
                          const std::filesystem::path& folder);

}  // namespace aims
