// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "bench/metrics/association.hpp"
#include "bench/metrics/localizability.hpp"
#include "bench/metrics/posterior_bound.hpp"

namespace aims {

/// Index of the stamp nearest to `stamp` and at most `tolerance` away, the earlier of two equally
/// near; `stamps` are in order of time.
std::optional<std::size_t> nearest_stamp(std::span<const Time> stamps, Time stamp,
                                         Duration tolerance);

/// Position covariance that an estimator states at the end of a scan.
struct StatedCovariance {
  Time stamp = 0;
  Eigen::Matrix3d position_in_body = Eigen::Matrix3d::Zero();  ///< [m^2]
};

/// An estimator's error along the weak axis of one scan.
struct WeakAxisError {
  Time stamp = 0;                   ///< of the scan
  double equivalent_returns = 0.0;  ///< of the scan
  double error_m = 0.0;             ///< signed; the axis' sign means nothing
  double bound_m = 0.0;             ///< posterior bound along the same axis
  std::optional<double> variance;   ///< stated by the estimator along it [m^2]
};

/// Errors along the weak axis at every scan for which there are an estimated pose and a bound
/// within `tolerance`. `pairs` are aligned at their start; `scans` and `bounds` belong
/// to the same scans.
std::vector<WeakAxisError> weak_axis_errors(std::span<const PosePair> pairs,
                                            std::span<const StatedCovariance> stated,
                                            std::span<const Localizability> scans,
                                            std::span<const PosteriorBound> bounds,
                                            Duration tolerance);

/// Summary of the errors along the weak axis over some scans; none of no scans.
struct WeakAxisScore {
  std::string level;  ///< "all", or the name of the degeneracy level that selects the scans
  int scans = 0;
  std::optional<double> error_rms_m;
  std::optional<double> bound_rms_m;
  /// Bound over error, both rms: 1 is optimal.
  std::optional<double> efficiency;
  /// Mean of error^2 over the stated variance (NEES): 1 is consistent, more is overconfident.
  std::optional<double> nees;
};

/// Scores over all scans, and over the degenerate scans of each level.
std::vector<WeakAxisScore> weak_axis_scores(std::span<const WeakAxisError> errors);

}  // namespace aims
