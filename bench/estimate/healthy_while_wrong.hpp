// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "bench/estimate/estimate.hpp"

namespace aims {

/// Fills in how long each scored estimator called itself healthy after its error exceeded the limit
/// of a success. Error when the file of its health cannot be read.
Result<void> add_healthy_while_wrong(EstimateResult& result);

}  // namespace aims
