// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "estimator/filter/error_state.hpp"

namespace aims {

/// Scale of the legs: the distance that legs and IMU measure over the distance that scans measure.
/// In the first, scans correct nothing along the path, as in a featureless corridor, where feet are
/// weighed by a velocity that legs and IMU alone determine.
class LegComparison {
 public:
  /// Adds the states at the end of a scan, `dt` [s] after the last one: by legs alone along the
  /// way, and by scans. `constrained`: whether the scan constrains the way. Only what lies between
  /// two such scans counts, and neither turns nor standing do.
  void add(const NominalState& by_legs, const NominalState& by_scans, double dt, bool constrained);

  /// Information about scale x, y, z and bias x, y, z of the legs: one row v s_x + b_x = z with
  /// the mean speed v, for the `state` whose scale and bias the way by legs has. Zero until there
  /// are a few pieces of the way, whose spread is its deviation.
  Eigen::MatrixXd information() const;
  Eigen::VectorXd vector(const NominalState& state) const;

 private:
  double variance() const;

  bool last_constrained_ = false;  ///< whether the two below are such a scan's
  NominalState last_by_legs_;
  NominalState last_by_scans_;
  double time_ = 0.0;   ///< of walking straight [s]
  double legs_ = 0.0;   ///< way by legs [m]
  double scans_ = 0.0;  ///< way by scans [m]
  double piece_legs_ = 0.0;
  double piece_scans_ = 0.0;
  int pieces_ = 0;
  double mean_ratio_ = 0.0;       ///< of way by legs and by scans, over pieces
  double square_of_ratio_ = 0.0;  ///< sum of squared deviations from the mean
};

}  // namespace aims
