// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "bench/tuning/sweep_store.hpp"

namespace aims {

/// Prints a row per estimator and point of a sweep in that score; nothing for a sweep without
/// ranges.
void print_points(const MergedSweep& sweep, const std::string& score);

}  // namespace aims
