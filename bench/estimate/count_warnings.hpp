// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "bench/estimate/estimate.hpp"

namespace aims {

/// Adds to the warnings what the counts of the whole recording say.
void warn_of_counts(EstimateResult& result);

/// Warns of a recording that is too short to judge an estimate by, in front of all else; yields the
/// text, empty without.
std::string warn_of_length(EstimateResult& result);

}  // namespace aims
