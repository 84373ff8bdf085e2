// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <span>

#include "core/config.hpp"
#include "estimator/constrained/constrained_step.hpp"
#include "estimator/constrained/scan_rule.hpp"

namespace aims {

/// X-ICP with the thresholds of the published package.
struct XIcpConfig {
  double minimal_angle_deg = 80.0;  ///< farther from a direction a correspondence is noise
  double strong_angle_deg = 45.0;   ///< nearer to it its contribution is a strong one
  double high_information = 300.0;
  double enough_information = 300.0;
  double insufficient_information = 150.0;
  double soft_weight = 0.0;
};

void describe(Fields& fields, XIcpConfig& config);

/// Localizability of a direction, the categories of X-ICP.
enum class LocalizabilityCategory {
  kNone,     ///< the update keeps the prediction
  kPartial,  ///< the contributing correspondences alone decide
  kFull,     ///< all correspondences decide
};

/// How a scan determines the pose along an eigenvector of its Hessian.
struct LocalizedDirection {
  Vector6 direction = Vector6::Zero();  ///< unit: of the rotation (body axes) or of the position
  double eigenvalue = 0.0;              ///< of the Hessian of unweighted correspondences
  double combined = 0.0;                ///< sum of the contributions that are no noise
  double strong = 0.0;                  ///< sum of the strong ones
  LocalizabilityCategory category = LocalizabilityCategory::kNone;
  double sampled = 0.0;  ///< kPartial: step for which its contributing correspondences ask
};

/// The eigenvectors of the rotational block of the Hessian and then those of the translational one,
/// each block by ascending eigenvalue, with their localizability. The contribution of a
/// correspondence to a direction is |n . e| for a translation; for a rotation |m . e| with
/// m = (p - p_mean) x n, which counts as a unit vector if it is longer than 1 m.
std::array<LocalizedDirection, 6> localizability(std::span<const Correspondence> correspondences,
                                                 const XIcpConfig& config);

/// The constraints of a step from a linearization that is `offset` away from the prior.
PoseConstraints constraints_of(std::span<const LocalizedDirection> directions,
                               const Vector6& offset);

/// X-ICP's update on the filter: along directions that are not localizable the pose stays as
/// predicted; along partially localizable ones it is where the resampled correspondences lie.
class XIcp final : public ScanRule {
 public:
  explicit XIcp(const XIcpConfig& config) : config_(config) {}

  RuledUpdate fuse(const Belief& prior, const NominalState& linearization,
                   const Linearization& scan,
                   std::span<const Correspondence> correspondences) const override;

 private:
  XIcpConfig config_;
};

}  // namespace aims
