// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <vector>

#include "estimator/filter/error_state.hpp"

namespace aims {

/// A row that is kept, and what it stands for.
struct KeptRow {
  int index = 0;
  double weight = 1.0;  ///< of its information: the inverse of the share of rows like it
};

/// Keeps about `limit` of the point-to-plane rows `jacobians`. A row is kept in proportion to its
/// leverage h^T A^-1 h, A = sum h h^T, and surely where that says so: the few rows that inform a
/// weak axis stay, the many that repeat each other are thinned. The weighted sum of what is kept
/// estimates A without bias. Thinning is even along the order of the rows; no draw is involved.
void select_rows(std::span<const Vector6> jacobians, int limit, std::vector<KeptRow>& kept);

}  // namespace aims
