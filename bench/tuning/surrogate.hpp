// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "bench/tuning/sobol_indices.hpp"
#include "core/error.hpp"

namespace aims {

/// A polynomial chaos expansion: a function in the unit cube as a sum of products of Legendre
/// polynomials that are orthonormal there (Xiu and Karniadakis 2002). Terms of up to three inputs
/// and of degree 10 in one, fewer in several (Blatman and Sudret 2011, q = 0.75), enter one by one,
/// the one that explains most first (orthogonal least squares, Chen et al. 1989), as long as the
/// leave-one-out error falls; the degree in an input is below the number of its different values.
/// The Sobol indices are sums of squared coefficients (Sudret 2008).
class Surrogate {
 public:
  /// Through `values` at `points` (a row each, in [0, 1]). Error for fewer than eight points, sizes
  /// that do not fit or what is not finite.
  static Result<Surrogate> fit(const Eigen::MatrixXd& points, const Eigen::VectorXd& values);

  double at(const Eigen::VectorXd& point) const;

  /// Root mean square error on points that were left out of everything, term selection included
  /// (ten folds) [unit of the values].
  double error() const { return error_; }

  /// That error at a point: more where the fit's leverage is above 1, as it is at none of its own
  /// points (Hoaglin and Welsch 1978), but in what an optimizer leaves empty [unit of the values].
  double error_at(const Eigen::VectorXd& point) const;

  /// True where the error is beyond the deviation of all values, so that their mean would predict
  /// as well, and more than 5 % of an input's range beyond all points of the fit.
  bool extrapolates(const Eigen::VectorXd& point) const;

  /// Fraction of the values' variance that is explained at points that were left out; at most 1,
  /// negative when the mean were better. 1 for values that do not vary.
  double explained() const { return explained_; }

  const SobolIndices& indices() const { return indices_; }
  std::size_t terms() const { return coefficients_.size(); }

 private:
  std::vector<std::vector<int>> degrees_;  ///< of each term in each input
  std::vector<double> coefficients_;
  Eigen::MatrixXd covariance_;  ///< of the coefficients, per variance of a value
  double error_ = 0.0;
  double explained_ = 0.0;
  double deviation_ = 0.0;  ///< of the values from their mean
  Eigen::VectorXd least_;   ///< of the points in each input
  Eigen::VectorXd most_;
  SobolIndices indices_;
};

}  // namespace aims
