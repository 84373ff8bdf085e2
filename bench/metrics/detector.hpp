// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

#include "core/time.hpp"

namespace aims {

/// The score of a detector for one scan, and the truth. Larger scores indicate degeneracy.
struct LabelledScan {
  Time stamp = 0;
  double score = 0.0;
  bool degenerate = false;  ///< ground truth
};

/// The scans of one run, in order of time. Scans without a finite score are left out beforehand.
using LabelledRun = std::vector<LabelledScan>;

/// Area under the ROC curve (AUC) of scans pooled over runs: U / (degenerate * others) with the
/// Mann-Whitney statistic U. 0.5 is a random score, less is a reversed one. None unless both
/// classes occur.
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
  double false_positive_rate = 0.0;  ///< alarms / scans that are not degenerate
  double true_positive_rate = 0.0;   ///< alarms / degenerate scans
};

/// The ROC curve of the pooled scans from (0, 0) to (1, 1), a point per score that occurs; empty
/// unless both classes occur.
std::vector<RocPoint> roc_curve(std::span<const LabelledRun> runs);

/// The point of the largest true positive rate within the given false positive rate; `curve` is not
/// empty.
RocPoint operating_point(std::span<const RocPoint> curve, double max_false_positive_rate);

/// Delays between the onset of degeneracy and the first alarm.
struct DetectionDelays {
  int onsets = 0;
  std::vector<double> delays_s;  ///< of the detected onsets
  int missed() const { return onsets - static_cast<int>(delays_s.size()); }
};

/// Delays from each true onset to the first alarm in the same degenerate interval. Intervals of
/// either class shorter than `min_duration` are merged with their neighbours; a degenerate interval
/// at the start of the run has no onset.
DetectionDelays detection_delays(const LabelledRun& run, double threshold, Duration min_duration);

}  // namespace aims
