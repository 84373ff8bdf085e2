// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <string>
#include <vector>

#include "bench/tuning/design.hpp"

namespace aims {

/// The values found, beside the defaults: "degeneracy.eta 0.13 instead of 3, degeneracy.kappa 10 as
/// by default". One in the outermost 2 % of its range is said to be there: "degeneracy.eta 0.13
/// instead of 3 (at the lower edge of its range 0.1 to 20: the optimum may lie outside)". One
/// without effect stays as by default.
std::string values_text(std::span<const ParameterRange> ranges, std::span<const double> defaults,
                        std::span<const double> values,
                        const std::vector<bool>& without_effect = {});

}  // namespace aims
