// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string_view>

#include "core/error.hpp"
#include "core/time.hpp"

namespace aims {

/// Physics steps per sample of a sensor with that rate [Hz]. Error, naming `key`, unless the
/// period is a whole number of steps: a rounded period would corrupt the sampling.
Result<int> steps_per_sample(std::string_view key, double rate, Duration timestep);

}  // namespace aims
