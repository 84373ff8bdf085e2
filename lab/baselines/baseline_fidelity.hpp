// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "bench/estimate/estimate.hpp"
#include "bench/metrics/scores.hpp"
#include "core/error.hpp"
#include "core/files/table.hpp"

namespace aims {

/// Whose poses a published trajectory holds.
enum class ReferenceBody { kImu, kLidar };

/// A recording, what a published system made of it, and the estimators that stand for that system.
struct BaselineFidelityRequest {
  EstimateConfig config;  ///< `run` holds the estimators, one for each reference
  EstimateOptions options;
  std::vector<std::filesystem::path> references;  ///< TUM
  ReferenceBody body = ReferenceBody::kImu;
  std::filesystem::path waypoint_times;  ///< empty: those that the recording holds
};

/// How far a baseline may be from the published system that stays on its way.
inline constexpr double kScoreTolerance = 0.3;          ///< of the published score [-]
inline constexpr double kMListTolerancePercent = 0.05;  ///< at least [percentage points]
inline constexpr double kMEndTolerance = 0.05;          ///< at least [m]

/// A baseline beside the published system. Both are scored at the stamps of the published poses.
struct BaselineComparison {
  std::string estimator;  ///< label
  std::string reference;  ///< file name
  Time start = 0;         ///< of the truth
  Scores published;
  Scores native;
  double rms_difference = 0.0;  ///< of the positions, first poses equal [m]
  double max_difference = 0.0;  ///< [m]

  /// Both diverge, or both succeed with scores within the tolerances.
  bool agrees() const;
};

/// RMS and greatest distance [m] of the positions of two trajectories at the stamps of `reference`
/// inside the span of `other`, whose first pose is laid onto that of the reference. Empty without
/// common stamps.
struct PositionDifference {
  double rms = 0.0;
  double max = 0.0;
};
std::optional<PositionDifference> position_difference(const Trajectory& other,
                                                      const Trajectory& reference);

/// Runs the estimators on the recording and compares each with its reference. Error for a recording
/// without truth, a reference that cannot be read or has no stamps in common with it, and as
/// `estimate`. A reference whose stamps begin before the truth's counts from the truth's start.
Result<std::vector<BaselineComparison>> baseline_fidelity(const BaselineFidelityRequest& request,
                                                          const Observer& observer);

/// Two rows per comparison, the published system first.
TextTable baseline_fidelity_table(const std::vector<BaselineComparison>& comparisons);

/// Writes baselines.md into `folder`.
Result<void> write_baseline_fidelity(const std::vector<BaselineComparison>& comparisons,
                                     const std::filesystem::path& folder);

}  // namespace aims
