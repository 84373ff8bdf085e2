// SPDX-License-Identifier: BSD-3-Clause
#include "sim/sensors/sampling.hpp"

#include <fmt/core.h>

namespace aims {

Result<int> steps_per_sample(std::string_view key, double rate, Duration timestep) {
  const Duration period = from_seconds(1.0 / rate);
  if (period < timestep || period % timestep != 0) {
    return failure(fmt::format(
        "{}: {} Hz is a period of {} ms; expected a whole number of physics steps of {} ms", key,
        rate, to_seconds(period) * 1e3, to_seconds(timestep) * 1e3));
  }
  return static_cast<int>(period / timestep);
}

}  // namespace aims
