// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <span>

#include "core/config.hpp"
#include "estimator/constrained/constrained_step.hpp"
#include "estimator/constrained/scan_rule.hpp"

namespace aims {

/// DCReg with its published parameters.
struct DcRegConfig {
  double condition_threshold = 10.0;
  double condition_target = 10.0;
  double tolerance = 1e-6;
  int max_iterations = 10;
  bool regularize = false;
};

void describe(Fields& fields, DcRegConfig& config);

/// A direction of the rotation or of the position, with the other block unknown.
struct SchurDirection {
  Vector6 direction = Vector6::Zero();  ///< unit eigenvector of the Schur complement
  double eigenvalue = 0.0;
  double clamped = 0.0;     ///< eigenvalue of the preconditioner
  bool degenerate = false;  ///< the largest eigenvalue is more than the threshold times this one
};

/// The eigenvectors of the Schur complements of `hessian`: three of the rotation, then three of the
/// position, each by ascending eigenvalue.
std::array<SchurDirection, 6> schur_directions(const Matrix6& hessian, const DcRegConfig& config);

/// Block-diagonal matrix with the clamped eigenvalues.
Matrix6 preconditioner_of(std::span<const SchurDirection> directions);

/// What the clamped eigenvalues are above the Schur complements' own: information about degenerate
/// directions alone.
Matrix6 clamping_of(std::span<const SchurDirection> directions);

/// Solution of a linear system, with the iterations that it took.
struct PcgSolution {
  Vector6 x = Vector6::Zero();
  int iterations = 0;
};

/// x of matrix x = vector by conjugate gradients from zero. Both matrices are positive definite.
/// Ends when the residual, in the norm of the preconditioner's inverse, is `tolerance` of the
/// first.
PcgSolution solve_by_pcg(const Matrix6& matrix, const Vector6& vector,
                         const Matrix6& preconditioner, double tolerance, int max_iterations);

/// DCReg's solver on the filter. The preconditioner leaves the minimizer of prior and scan as it
/// is; with `regularize` the clamped eigenvalues are information that holds the prediction.
class DcReg final : public ScanRule {
 public:
  explicit DcReg(const DcRegConfig& config) : config_(config) {}

  RuledUpdate fuse(const Belief& prior, const NominalState& linearization,
                   const Linearization& scan,
                   std::span<const Correspondence> correspondences) const override;

 private:
  DcRegConfig config_;
};

}  // namespace aims
