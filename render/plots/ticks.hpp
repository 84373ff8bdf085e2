// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

namespace aims {

/// A tick of an axis and its label.
struct Tick {
  double value = 0.0;
  std::string label;
};

/// At most `max_count` (>= 2) ticks at 1, 2 or 5 times a power of ten inside [min, max]; empty
/// when the interval is empty or not finite.
std::vector<Tick> linear_ticks(double min, double max, int max_count);

/// Ticks at powers of ten inside [min, max], with 2 and 5 in between when there are fewer than
/// three, and evenly spaced ones when even those are fewer; empty when the interval is empty, not
/// finite or not positive.
std::vector<Tick> logarithmic_ticks(double min, double max);

}  // namespace aims
