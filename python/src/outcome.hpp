// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "bench/scoring/outcome.hpp"
#include "python/src/conversion.hpp"

namespace aims::python {

/// What an estimator came to, as the dict that `aims.Outcome` is made of.
py::dict outcome_of(const EstimatorOutcome& outcome);

}  // namespace aims::python
