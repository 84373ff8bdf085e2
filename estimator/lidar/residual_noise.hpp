// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

namespace aims {

/// A point-to-plane residual and how its beam met the plane.
struct IncidentResidual {
  double residual = 0.0;  ///< [m]
  double cosine = 1.0;    ///< |cos| of the angle between beam and normal
};

/// Noise of point-to-plane residuals, learned from the residuals: range noise acts along the beam,
/// so it enters with the cosine of the incidence; map, pose and motion within the scan add the
/// rest. The variance is rest^2 + range^2 cosine^2.
class ResidualNoise {
 public:
  /// Deviation of one residual [m].
  double sigma(double cosine) const;

  /// Adds the residuals of a scan. Deviations come from median magnitudes, so that residuals of
  /// moving things do not count.
  void learn(const std::vector<IncidentResidual>& residuals);

 private:
  double grazing_ = 0.01;  ///< deviation at grazing incidence [m]
  double facing_ = 0.03;   ///< at about perpendicular incidence, as datasheets state it [m]
  std::vector<double> magnitudes_;
};

}  // namespace aims
