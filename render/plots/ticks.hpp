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

/// About `most` ticks at 1, 2 or 5 times a power of ten inside [min, max]; empty when the interval
/// is empty or not finite. Pages have the same rule (render/page/web/src/charts/axis.ts);
/// tests/render/plots/ticks.txt holds both.
std::vector<Tick> linear_ticks(double min, double max, int most);

/// The finest of 1-2-5, 1-3 and 1 per decade that gives at most one more than `most` (>= 1) ticks,
/// else every so many decades; evenly spaced ones in less than a decade; empty when the interval is
/// empty, not finite or not positive.
std::vector<Tick> logarithmic_ticks(double min, double max, int most);

}  // namespace aims
