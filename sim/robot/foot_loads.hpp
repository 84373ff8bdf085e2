// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>

#include "core/measurements.hpp"

namespace aims {

using FootLoads = std::array<double, kLegCount>;  ///< normal force on each foot [N]

}  // namespace aims
