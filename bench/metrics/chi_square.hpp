// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace aims {

/// Probability that a chi-square variable of `dof` > 0 degrees of freedom is at most `value`.
double chi_square_probability(double value, double dof);

/// The value that a chi-square variable of `dof` > 0 degrees of freedom stays below with
/// `probability` in (0, 1).
double chi_square_quantile(double probability, double dof);

}  // namespace aims
