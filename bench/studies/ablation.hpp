// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "bench/scoring/score_statistics.hpp"
#include "bench/studies/suite.hpp"
#include "core/error.hpp"
#include "core/files/table.hpp"
#include "estimator/estimator_spec.hpp"

namespace aims {

/// Version of the layout of ablation.json; see docs/result-files.md.
inline constexpr std::string_view kAblationSchema = "aims.ablation/2";

/// The scores that an ablation compares: the headline ones, and the NEES along the weak axis.
inline constexpr std::size_t kAblationCount = kHeadlineCount + 1;
const std::array<Score, kAblationCount>& ablation_scores();

struct AblationOptions {
  std::string estimator = "aims_d";    ///< spec of what is taken apart
  std::vector<std::string> groups;     ///< of its settings, whose flags are turned over; empty: all
  std::vector<std::string> baselines;  ///< specs that run beside it
};

/// One variant on one scenario.
struct AblationRow {
  std::string label;
  std::size_t runs = 0;
  std::size_t successes = 0;
  SuccessRate strict;                                  ///< within 1 %
  McNemarTest success_test;                            ///< complete estimator first
  std::array<PairedStatistics, kAblationCount> cells;  ///< against the complete estimator
};

struct AblationCase {
  std::string scenario;
  std::vector<AblationRow> rows;  ///< the complete estimator first
};

/// One variant over all scenarios.
struct AblationEffect {
  std::string label;
  std::string changes;  ///< its settings, e.g. "ground_constraint.enabled=false"
  /// Geometric means over scenarios of the ratios; none without any.
  std::array<std::optional<double>, kAblationCount> ratios;
  std::optional<double> worst_ratio;  ///< of the ATE, over scenarios
  std::string worst_scenario;
  std::size_t runs = 0;
  std::size_t successes = 0;
  std::size_t compared = 0;  ///< runs with an ATE of both: where parts are missing, fewer
};

struct Ablation {
  std::string complete;  ///< label of what is taken apart
  std::vector<AblationCase> cases;
  std::vector<AblationEffect> effects;
};

/// The estimator `spec` and, for each flag of the groups, itself with that flag turned over:
/// `no_...` where it was on, `with_...` where it was off in `base`. Without groups, itself without
/// each part that can be switched off alone. Error for a spec that cannot be read, and for a group
/// without flags that have an effect.
Result<std::vector<std::string>> ablation_specs(const std::string& spec,
                                                const std::vector<std::string>& groups,
                                                const EstimatorConfigs& base);

/// Sums up a suite that ran variants of the estimator with the label `complete`.
Ablation ablation_of(const Suite& suite, const std::string& complete);

/// Gives every scenario the estimator, its variants and the baselines. Error as of
/// `ablation_specs`, and for two specs of one label.
Result<void> set_variants(const AblationOptions& options, std::vector<ScenarioFile>& scenarios);

/// A row per variant: geometric means of the ratios over scenarios.
TextTable effect_table(const Ablation& ablation);

/// Variants on one scenario: "median (x ratio)" of each score.
TextTable case_table(const AblationCase& each);

/// Writes ablation.md, ablation.csv and ablation.json into `folder`.
Result<void> write_ablation(const Ablation& ablation, const Suite& suite,
                            const std::filesystem::path& folder);

}  // namespace aims
