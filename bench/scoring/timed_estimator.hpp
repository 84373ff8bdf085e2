// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "bench/scoring/health_time.hpp"
#include "core/trajectory.hpp"
#include "estimator/interface/diagnostics.hpp"
#include "estimator/interface/estimator.hpp"
#include "estimator/interface/health.hpp"

namespace aims {

/// Consecutive rows of what an estimator reports, valid until its next measurement.
struct EstimatorRows {
  std::span<const StampedPose> poses;  ///< T_odom_body
  std::span<const SeriesInfo> series;  ///< of the scans
  std::span<const ScanRow> scans;
  std::span<const double> wall_ms;  ///< of the scans, from the first; may be fewer [ms]
  std::span<const HealthRow> health;
};

/// What is kept of all rows of an estimator; its memory does not grow with their number.
struct EstimatorTotals {
  std::size_t poses = 0;
  std::size_t scans = 0;
  double path_m = 0.0;  ///< sum of the distances from pose to pose
  Pose first_pose;      ///< T_odom_body; identity without poses, as the last one
  Pose last_pose;
  HealthSummary health;
};

/// Adds the rows that follow those added before.
void add_rows(const EstimatorRows& rows, EstimatorTotals& totals);

/// What the scans of an estimator took, from one scan to the next: the scan and all samples since
/// the scan before [ms].
struct ScanTimes {
  std::vector<double> wall_ms;  ///< grows on a busy machine
  std::vector<double> cpu_ms;   ///< of the thread, and of the process of one in Python
};

/// An estimator and the time that it takes: estimators themselves never read a clock.
class TimedEstimator {
 public:
  TimedEstimator(std::string name, std::unique_ptr<Estimator> estimator);

  void consume(std::span<const Delivery> deliveries);
  void finish();

  const std::string& name() const { return name_; }
  const Estimator& estimator() const { return *estimator_; }
  /// Wall time.
  double total_seconds() const { return total_seconds_; }
  const ScanTimes& scan_times() const { return scan_times_; }

  /// The rows that follow those that `pass` went past; at first all.
  EstimatorRows rows() const;
  /// Goes past the rows so far.
  void pass();
  /// Goes past the rows so far, and has the estimator let go of them where it can.
  void forget();

 private:
  std::size_t scans_done() const;
  template <class Work>
  void timed(const Work& work);

  std::string name_;
  std::unique_ptr<Estimator> estimator_;
  double total_seconds_ = 0.0;
  double wall_since_scan_ = 0.0;  ///< [s]
  double cpu_since_scan_ = 0.0;   ///< [s]
  ScanTimes scan_times_;
  std::size_t poses_passed_ = 0;
  std::size_t scans_passed_ = 0;
  std::size_t health_passed_ = 0;
  std::size_t poses_forgotten_ = 0;  ///< no longer in the result
  std::size_t scans_forgotten_ = 0;
};

}  // namespace aims
