// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <span>

namespace aims {

/// Kendall's rank correlation of pairs (x_i, y_i), in [-1, 1]: 1 where both put them in the same
/// order, -1 where in the opposite one. Form tau-b, which corrects for ties (Kendall 1945). An
/// infinite value is larger than any other and tied with its like. None when all x or all y are
/// tied, below two pairs, or when a value is NaN. Both have the same length.
std::optional<double> kendall_tau(std::span<const double> x, std::span<const double> y);

}  // namespace aims
