// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "bench/studies/suite.hpp"
#include "core/error.hpp"
#include "core/files/table.hpp"
#include "estimator/estimator_spec.hpp"

namespace aims {

/// Version of the layout of sensitivity.json.
inline constexpr std::string_view kSensitivitySchema = "aims.sensitivity/1";

struct SensitivityOptions {
  std::string estimator = "aims_d";          ///< spec whose settings are varied
  std::vector<double> factors = {0.5, 2.0};  ///< on each number, one setting at a time
};

/// One setting times one factor.
struct SettingVariant {
  std::string key;    ///< below the estimator, e.g. "map.voxel_size"
  std::string value;  ///< as the estimator has it
  double factor = 1.0;
  std::optional<EstimatorSpec> spec;  ///< none where the setting does not allow the value
};

/// Every number of the estimator `text` that has an effect, times each factor; integers rounded,
/// all entries of a vector at once. Error for a spec that cannot be read.
Result<std::vector<SettingVariant>> setting_variants(const std::string& text,
                                                     const std::vector<double>& factors,
                                                     const EstimatorConfigs& base);

/// Runs of one variant and of the estimator itself on the same sequences.
struct SensitivityCell {
  double factor = 1.0;
  std::size_t pairs = 0;        ///< sequences on which both have an ATE
  std::optional<double> ratio;  ///< of the median ATE, variant over estimator
  int lost = 0;                 ///< sequences on which the estimator alone succeeds
  int won = 0;                  ///< sequences on which the variant alone succeeds
  double success_p = 1.0;       ///< sign test of the successes over seeds
};

struct SensitivityRow {
  std::string key;
  std::string value;
  std::vector<SensitivityCell> cells;  ///< by factor; no pairs where the value is not allowed

  /// Largest of |ratio - 1|; none without any ratio.
  std::optional<double> largest_change() const;

  /// Most successes that a factor costs on balance, at least 0.
  int most_lost() const;
};

struct SettingSensitivity {
  std::string estimator;             ///< its label
  std::optional<double> median_ate;  ///< [m]
  std::size_t sequences = 0;
  std::vector<SensitivityRow> rows;  ///< most successes lost first, then largest change
};

/// Gives every scenario the estimator and its variants. Error as of `setting_variants`.
Result<std::vector<SettingVariant>> set_setting_variants(const SensitivityOptions& options,
                                                         std::vector<ScenarioFile>& scenarios);

/// Sums up a suite of the estimator with the label `estimator` and its variants, all scenarios
/// together.
SettingSensitivity sensitivity_of(const Suite& suite, const std::string& estimator,
                                  const std::vector<SettingVariant>& variants);

/// A row per setting: value, ratio of the median ATE per factor, runs lost and won.
TextTable sensitivity_table(const SettingSensitivity& sensitivity);

/// Writes sensitivity.md, sensitivity.csv and sensitivity.json into `folder`.
Result<void> write_sensitivity(const SettingSensitivity& sensitivity, const Suite& suite,
                               const std::filesystem::path& folder);

}  // namespace aims
