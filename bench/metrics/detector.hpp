// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

#include "core/time.hpp"

namespace aims {

/// One scan as a detector and the truth see it. Larger scores speak for degeneracy.
struct LabelledScan {
  Time stamp = 0;
  double score = 0.0;
  bool degenerate = false;  ///< by the truth
};

/// The scans of one run, in order of time. Scans without a finite score are left out beforehand.
using LabelledRun = std::vector<LabelledScan>;

/// How often a degenerate scan of `positives` scores above another of `negatives`, ties counting
/// half: the Mann-Whitney statistic U.
double mann_whitney(const LabelledRun& positives, const LabelledRun& negatives);

/// Area under the ROC curve of scans pooled over runs, U / (degenerate * others): 0.5 is chance,
/// below it the score points the wrong way. None unless both classes occur.
class AucTable {
 public:
  explicit AucTable(std::span<const LabelledRun> runs);

  /// Over all runs.
  std::optional<double> auc() const;
  /// Over the runs with these indices, one as often as it is named.
  std::optional<double> auc(std::span<const std::size_t> runs) const;

 private:
  Eigen::MatrixXd wins_;  ///< U of the degenerate scans of run i over the others of run j
  Eigen::VectorXd degenerate_;
  Eigen::VectorXd others_;
};

/// A detector that alarms at scores of at least `threshold`.
struct RocPoint {
  double threshold = 0.0;
  double false_alarms = 0.0;  ///< share of the scans that are not degenerate
  double detections = 0.0;    ///< share of those that are
};

/// The ROC curve of the pooled scans from (0, 0) to (1, 1), a point per score that occurs; empty
/// unless both classes occur.
std::vector<RocPoint> roc_curve(std::span<const LabelledRun> runs);

/// The point of most detections with at most that share of false alarms; `curve` is not empty.
RocPoint operating_point(std::span<const RocPoint> curve, double most_false_alarms);

/// How soon a detector alarmed after degeneracy set in.
struct DetectionDelays {
  int onsets = 0;
  std::vector<double> delays_s;  ///< of the detected ones
  int missed() const { return onsets - static_cast<int>(delays_s.size()); }
};

/// Delays from each true onset to the first alarm within the same spell. Spells of degeneracy and
/// pauses between them that are shorter than `shortest` do not count as such; a spell that is
/// under way when the run starts has no onset.
DetectionDelays detection_delays(const LabelledRun& run, double threshold, Duration shortest);

}  // namespace aims
