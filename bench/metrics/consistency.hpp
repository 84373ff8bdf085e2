// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "bench/metrics/statistics.hpp"

namespace aims {

/// The error of an estimator along one axis at one instant of a run, with its stated deviation.
struct ConsistencySample {
  double time_s = 0.0;
  double error_m = 0.0;           ///< signed; its sign means nothing
  std::optional<double> sigma_m;  ///< stated by the estimator; none or not positive: not stated
  double bound_m = 0.0;           ///< posterior Cramer-Rao bound, all sensors, unknown map
  double leg_bound_m = 0.0;       ///< the same without the LiDAR
};

/// The samples of one run in order of time, on a time axis that all runs share; the last is the end
/// of the run.
using ConsistencyRun = std::vector<ConsistencySample>;

/// A fraction of runs with its 95 % interval (Wilson 1927).
struct Coverage {
  int inside = 0;
  int runs = 0;
  std::optional<double> fraction;
  Interval interval;
};

/// One instant over all runs that reach it.
struct ConsistencyInstant {
  double time_s = 0.0;
  Coverage covered;                   ///< inside 2 sigma, of the runs that state a covariance here
  std::optional<double> nees;         ///< mean over them of error^2 over the stated variance
  Interval bounds;                    ///< 95 % bounds of a consistent filter: chi-square / runs
  double error_rms_m = 0.0;           ///< over runs, as are the following
  std::optional<double> sigma_rms_m;  ///< of the runs that state a covariance
  double bound_rms_m = 0.0;
  double leg_bound_rms_m = 0.0;
  std::optional<double> efficiency;  ///< bound over error, both rms

  bool inside() const { return nees && *nees >= *bounds.low && *nees <= *bounds.high; }
  bool above() const { return nees && *nees > *bounds.high; }
};

/// Agreement of the error along the weak axis with the stated covariance, over runs.
struct Consistency {
  int runs = 0;
  std::vector<ConsistencyInstant> instants;
  ConsistencyInstant end;  ///< each run's last sample; the time is the latest of them
  int judged = 0;          ///< instants with at least two runs and half of all
  std::optional<double> inside_fraction;  ///< of them, with the mean NEES inside its bounds
  std::optional<double> above_fraction;   ///< of them, with the mean NEES above its bounds
  std::optional<double> mean_nees;        ///< mean over runs of their means over time
  Interval mean_nees_interval;            ///< 95 % bootstrap over runs
  Coverage two_sigma;                     ///< samples inside 2 sigma (no interval: they correlate)
  double error_rms_m = 0.0;               ///< over runs and time
  std::optional<double> efficiency;       ///< bound over error, both rms over runs and time
};

/// Bounds within which the mean over `runs` of a normalized estimation error squared (NEES) of one
/// dimension lies with 95 % probability when the filter is consistent (Bar-Shalom, Li and
/// Kirubarajan 2001, section 5.4.2). Empty for no runs.
Interval mean_nees_bounds(int runs);

/// Fraction `inside` / `runs`, with its interval when the trials are independent.
Coverage coverage_of(int inside, int runs, bool independent);

/// Consistency over runs of one scenario; samples of equal time form an instant. Errors of a run
/// correlate over time, so bounds are per instant; the fraction of instants inside them has no
/// exact distribution, but is 95 % on average when the filter is consistent.
Consistency consistency_of(std::span<const ConsistencyRun> runs);

}  // namespace aims
