// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/constrained/dcreg.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "estimator/filter/pose_information.hpp"

namespace aims {
namespace {

/// Of the pose, where H is singular: far below what one return adds [1/rad^2, 1/m^2].
constexpr double kLeastEigenvalue = 1e-9;

}  // namespace

void describe(Fields& f, DcRegConfig& c) {
  const std::string source = "Hu et al. 2025, published program";
  f.number("condition_threshold", c.condition_threshold,
           {"-", in_range(1.0, 1e12),
            "a direction is degenerate if the largest eigenvalue of its Schur complement is more "
            "times its own",
            source});
  f.number("condition_target", c.condition_target,
           {"-", in_range(1.0, 1e12), "condition number to which the preconditioner is clamped",
            source});
  f.number("tolerance", c.tolerance,
           {"-", in_range(1e-15, 1.0), "residual at which conjugate gradients end, of the first",
            source});
  f.integer("max_iterations", c.max_iterations,
            {"-", in_range(1, 1000), "of conjugate gradients", source});
  f.flag("regularize", c.regularize,
         {"", any(),
          "clamp the problem itself and not only its preconditioner, which pulls degenerate "
          "directions towards the prediction; not published by the authors"});
}

std::array<SchurDirection, 6> schur_directions(const Matrix6& hessian, const DcRegConfig& config) {
  using E = ErrorState;
  std::array<SchurDirection, 6> directions;
  for (int b = 0; b < 2; ++b) {
    const E::Block of = b == 0 ? E::kRotation : E::kPosition;
    const E::Block other = b == 0 ? E::kPosition : E::kRotation;
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(schur_complement(
        block(hessian, of, of), block(hessian, of, other), block(hessian, other, other)));
    const double largest = std::max(solver.eigenvalues()(2), kLeastEigenvalue);
    for (int i = 0; i < 3; ++i) {
      SchurDirection& it = directions[static_cast<std::size_t>(3 * b + i)];
      it.direction.segment<3>(of.offset) = solver.eigenvectors().col(i);
      it.eigenvalue = std::max(solver.eigenvalues()(i), 0.0);
      it.degenerate = it.eigenvalue * config.condition_threshold < largest;
      it.clamped = it.degenerate ? std::max(it.eigenvalue, largest / config.condition_target)
                                 : std::max(it.eigenvalue, kLeastEigenvalue);
    }
  }
  return directions;
}

Matrix6 preconditioner_of(std::span<const SchurDirection> directions) {
  Matrix6 sum = Matrix6::Zero();
  for (const SchurDirection& each : directions) {
    sum += each.clamped * each.direction * each.direction.transpose();
  }
  return sum;
}

Matrix6 clamping_of(std::span<const SchurDirection> directions) {
  Matrix6 sum = Matrix6::Zero();
  for (const SchurDirection& each : directions) {
    if (!each.degenerate) continue;
    sum += (each.clamped - each.eigenvalue) * each.direction * each.direction.transpose();
  }
  return sum;
}

PcgSolution solve_by_pcg(const Matrix6& matrix, const Vector6& vector,
                         const Matrix6& preconditioner, double tolerance, int max_iterations) {
  const Eigen::LDLT<Matrix6> inverse(preconditioner);
  PcgSolution solution;
  Vector6 residual = vector;
  Vector6 preconditioned = inverse.solve(residual);
  Vector6 search = preconditioned;
  double size = residual.dot(preconditioned);
  const double enough = tolerance * tolerance * size;
  while (size > enough && solution.iterations < max_iterations) {
    const Vector6 image = matrix * search;
    const double curvature = search.dot(image);
    if (!(curvature > 0.0)) break;  // rounding: the residual has no other part
    const double step = size / curvature;
    solution.x += step * search;
    residual -= step * image;
    preconditioned = inverse.solve(residual);
    const double next = residual.dot(preconditioned);
    search = preconditioned + next / size * search;
    size = next;
    ++solution.iterations;
  }
  return solution;
}

RuledUpdate DcReg::fuse(const Belief& prior, const NominalState& linearization,
                        const Linearization& scan,
                        std::span<const Correspondence> /*correspondences*/) const {
  const auto directions = schur_directions(scan.measurement.matrix, config_);
  const LinearScan linear(prior, linearization, scan.measurement);
  Matrix6 information = linear.A;
  if (config_.regularize) information += clamping_of(directions);
  // About the pose alone, (S^-1 + A) y = -innovation; the other states follow by their covariance.
  const Eigen::LDLT<Matrix6> known(linear.S);
  const Matrix6 prior_information = known.solve(Matrix6::Identity());
  const Matrix6 system = prior_information + information;
  const Vector6 pose = solve_by_pcg(system, -linear.innovation, preconditioner_of(directions),
                                    config_.tolerance, config_.max_iterations)
                           .x;
  const ErrorVector correction = linear.PH * known.solve(pose);
  const Matrix6 inverse = (Matrix6::Identity() + information * linear.S).inverse();
  ScanVerdict verdict;
  for (std::size_t i = 0; i < directions.size(); ++i) {
    if (directions[i].degenerate) (i < 3 ? verdict.rotation : verdict.translation) = true;
  }
  return {linear.corrected(correction, linear.PH * inverse, scan.mask), verdict};
}

}  // namespace aims
