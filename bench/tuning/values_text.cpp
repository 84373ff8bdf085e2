// SPDX-License-Identifier: BSD-3-Clause
#include "bench/tuning/values_text.hpp"

#include <fmt/format.h>

#include <cstddef>
#include <vector>

#include "bench/tuning/range_key.hpp"

namespace aims {
namespace {

constexpr double kEdge = 0.02;  ///< this near to an end, in widths of the range

constexpr double kAtEdge = 1e-9;  ///< likewise; farther off a value is near it

/// " (at the lower edge ...)", or nothing.
std::string edge_text(const ParameterRange& range, double value) {
  const double fraction = fraction_of(range, value);
  if (fraction < -kEdge || fraction > 1.0 + kEdge) return "";  // a default beyond the range
  const bool lower = fraction <= kEdge;
  if (!lower && fraction < 1.0 - kEdge) return "";
  const Range allowed = allowed_values(range);
  const bool final = lower ? range.low <= allowed.min : range.high >= allowed.max;
  const bool at = lower ? fraction <= kAtEdge : fraction >= 1.0 - kAtEdge;
  const std::string beyond =
      final ? fmt::format("values {} {} are not allowed", lower ? "below" : "above",
                          lower ? range.low : range.high)
            : "the optimum may lie outside";
  return fmt::format(" ({} the {} edge of its range {} to {}: {})", at ? "at" : "near",
                     lower ? "lower" : "upper", range.low, range.high, beyond);
}

}  // namespace

std::string values_text(std::span<const ParameterRange> ranges, std::span<const double> defaults,
                        std::span<const double> values, const std::vector<bool>& without_effect) {
  std::vector<std::string> texts;
  for (std::size_t i = 0; i < ranges.size(); ++i) {
    if (i < without_effect.size() && without_effect[i]) {
      texts.push_back(
          fmt::format("{} {:.3g} as by default (no effect measured)", ranges[i].key, defaults[i]));
      continue;
    }
    const std::string value = fmt::format("{:.3g}", values[i]);
    const std::string before = fmt::format("{:.3g}", defaults[i]);
    const std::string beside = value == before ? " as by default" : " instead of " + before;
    texts.push_back(ranges[i].key + " " + value + beside + edge_text(ranges[i], values[i]));
  }
  return fmt::format("{}", fmt::join(texts, ", "));
}

}  // namespace aims
