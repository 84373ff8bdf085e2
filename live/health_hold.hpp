// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <deque>

#include "estimator/interface/health.hpp"

namespace aims {

/// Whether both say the same, in any order, but for figures: "12 messages dropped".
bool alike(const HealthRow& a, const HealthRow& b);

/// Keeps what comes and goes in the health, so that it does not flicker.
class HealthHold {
 public:
  static constexpr Duration kHold = 5 * kSecond;

  /// The row with the worst state of the last `kHold` and all its reasons, the row's own first.
  HealthRow held(const HealthRow& row);

 private:
  std::deque<HealthRow> recent_;  ///< within `kHold`
};

}  // namespace aims
