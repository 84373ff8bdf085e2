// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace aims {

/// How a line is broken.
enum class LinePattern { kSolid, kDashed, kDashDotted, kDotted };

/// Lengths of line and gap in turn [px]; none for a solid line.
std::span<const double> dash_lengths(LinePattern pattern);

/// What distinguishes a line from others, with colour and without.
struct SeriesStyle {
  std::uint32_t light = 0;  ///< 0xRRGGBB (sRGB), on white
  std::uint32_t dark = 0;   ///< the same hue on a dark ground
  LinePattern pattern = LinePattern::kSolid;
};

/// Styles before they repeat: twelve colours in four turns, each colour in each turn with the next
/// of the four patterns.
inline constexpr std::size_t kSeriesColors = 12;
inline constexpr std::size_t kSeriesStyles = 4 * kSeriesColors;

/// Style `index` (cyclic). Within the first twelve any two colours are at least 0.085 apart in
/// Oklab, also as seen without red, green or blue cones (Machado et al. 2009).
SeriesStyle series_style(std::size_t index);

/// Index of the style of each label. An estimator of this project has one of its own, the same in
/// every picture and page. A variant ("aims_d+KEY=VALUE") takes the second style of its estimator's
/// colour, any other label one by its letters; both the next free one where that is taken.
std::vector<std::size_t> series_styles(std::span<const std::string> labels);

}  // namespace aims
