// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "bench/metrics/detector.hpp"
#include "bench/metrics/localizability.hpp"
#include "bench/metrics/statistics.hpp"
#include "bench/studies/suite.hpp"
#include "core/error.hpp"
#include "core/files/table.hpp"
#include "estimator/interface/estimator.hpp"

namespace aims {

/// A series of an estimator's diagnostics as a detector of degeneracy, in the direction that its
/// source states; an AUC below 0.5 refutes that direction.
struct DegeneracyIndex {
  std::string name;  ///< of the series
  bool high_is_degenerate = true;
  std::string source;  ///< who states the direction
};

/// Every index that is judged, of the estimators that report its series.
const std::vector<DegeneracyIndex>& degeneracy_indices();

/// One scan with an update: each index' value and the truth.
struct DetectorScan {
  Time stamp = 0;
  std::vector<double> values;       ///< by index; NaN: not computed
  double equivalent_returns = 0.0;  ///< by the truth
};

/// The scans of one run of one scenario.
struct DetectorRun {
  std::string scenario;
  std::uint64_t seed = 0;
  std::vector<DetectorScan> scans;
  int without_update = 0;  ///< scans left out because the estimator made no update
  int without_truth = 0;   ///< scans left out because no scan information is near their stamp
};

/// Pairs every scan's diagnostics with the true scan information nearest in time, at most
/// `tolerance` away.
DetectorRun detector_run(const Diagnostics& diagnostics, std::span<const Localizability> truth,
                         Duration tolerance);

/// How one index does as a detector of one degeneracy level over a set of runs.
struct DetectorScore {
  std::string index;
  std::string level;
  std::string scenario;  ///< empty: pooled over all
  int runs = 0;
  int scans = 0;
  int degenerate = 0;                ///< scans that are
  std::optional<double> auc;         ///< none: the truth never changes
  Interval auc_interval;             ///< 95 %, bootstrap over runs
  std::optional<double> detections;  ///< fraction at the operating point
  std::optional<double> threshold;   ///< of the index there, in its own unit and sign
  int onsets = 0;
  int missed = 0;
  std::optional<double> median_delay_s;  ///< of the detected onsets
  std::vector<RocPoint> curve;           ///< at most a few hundred points
};

/// False alarms allowed at the operating point.
inline constexpr double kFalseAlarms = 0.05;

/// Scores of every index at every level, pooled and per scenario. Scores of one scenario follow
/// those pooled; within each, levels and then indices in their order. An index that no scan has a
/// value of is left out.
std::vector<DetectorScore> score_detectors(std::span<const DetectorRun> runs);

struct DetectorStudy {
  std::string estimator;          ///< its label
  std::vector<DetectorRun> runs;  ///< scenario by scenario, seed by seed
  std::vector<DetectorScore> scores;
  std::vector<std::string> warnings;  ///< e.g. a level that the truth never crosses
};

/// Judges the indices of an estimator by the jobs of a suite with one estimator that kept
/// trajectories in the store `folder`. Error when the estimator has no diagnostics of scans, or a
/// file cannot be read.
Result<DetectorStudy> detector_study(const Suite& suite, const std::filesystem::path& folder);

/// The pooled scores as a table: an index per row, and per level AUC with its interval, detections
/// at 5 % false alarms, median delay and missed onsets.
TextTable detector_table(std::span<const DetectorScore> scores);

/// Why some scores have no value, a line per level and set of runs that the truth never changes in.
std::vector<std::string> undecided_levels(std::span<const DetectorScore> scores);

/// Writes detectors.json, detectors.csv and detectors.md into `folder`.
Result<void> write_detectors(const DetectorStudy& study, const std::filesystem::path& folder);

}  // namespace aims
