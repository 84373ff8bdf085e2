// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtest/gtest.h>

#include <cmath>

#include "core/config.hpp"

namespace aims::testing {

/// Whether the parameter is a number or a vector of numbers.
inline bool is_numeric(const Parameter& parameter) {
  return is_number(parameter) || parameter.kind == ParameterKind::kVector;
}

/// Every number is bounded on both sides, so that nothing that is computed from it overflows.
inline void expect_bounded(const Fields& fields) {
  for (const Parameter& parameter : fields.parameters()) {
    if (!is_numeric(parameter)) continue;
    const Range& range = parameter.spec.range;
    EXPECT_TRUE(std::isfinite(range.min) && std::isfinite(range.max)) << parameter.key;
    EXPECT_LT(range.min, range.max) << parameter.key;
  }
}

}  // namespace aims::testing
