// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "bench/estimate/estimate.hpp"

namespace aims {

/// Adds to the warnings what the counts of the whole recording say.
void warn_of_counts(EstimateResult& result);

}  // namespace aims
