// SPDX-License-Identifier: BSD-3-Clause
#include "core/series_style.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

namespace aims {
namespace {

/// Found by simulated annealing over Oklab: the least difference of any two, seen by normal eyes
/// and by the three kinds of dichromats, is as large as can be.
constexpr std::array<std::pair<std::uint32_t, std::uint32_t>, kSeriesColors> kColors = {{
    {0x2a24de, 0x455ef8},  // blue
    {0xe7963d, 0xfd8537},  // orange
    {0x13c097, 0x62f19f},  // mint
    {0xf12e1d, 0xe5481e},  // red
    {0x264e01, 0xc1e319},  // green
    {0x138db1, 0x3baece},  // teal
    {0xbf93f1, 0x9982f8},  // lavender
    {0x95796d, 0xc5ac98},  // clay
    {0xda2ffc, 0xfeb6ee},  // magenta
    {0x9c1854, 0xb87974},  // crimson
    {0x520277, 0x9351bd},  // violet
    {0x764297, 0xb94082},  // plum
}};

constexpr std::array<LinePattern, 4> kPatterns = {LinePattern::kSolid, LinePattern::kDashed,
                                                  LinePattern::kDashDotted, LinePattern::kDotted};

/// Styles of the estimators; a published preset has the colour of its system.
constexpr std::array<std::pair<std::string_view, std::size_t>, 25> kOfEstimators = {{
    {"aims_d", 0},
    {"aims", 1},
    {"tfs_plus", 2},
    {"lio", 3},
    {"leg", 4},
    {"tfs", 5},
    {"tfs_clean", 6},
    {"leg_inertial", 7},
    {"fast_lio2", 8},
    {"loam", 9},
    {"lego_loam", 10},
    {"lins", 11},
    {"a_loam", 13},
    {"lio_sam_published", 14},
    {"lio_sam", 17},
    {"leg_kilo_published", 18},
    {"leg_kilo", 19},
    {"fast_lio2_published", 20},
    {"loam_published", 21},
    {"lego_loam_published", 22},
    {"lins_published", 23},
    {"x_icp_published", 12},
    {"x_icp", 15},
    {"dcreg", 16},
    {"bievr", 31},
}};

std::optional<std::size_t> fixed_style(std::string_view name) {
  const auto* found =
      std::ranges::find(kOfEstimators, name, &std::pair<std::string_view, std::size_t>::first);
  return found == kOfEstimators.end() ? std::nullopt : std::optional(found->second);
}

/// A label has its style in the first two turns while it is free.
constexpr std::size_t kPreferredStyles = 2 * kSeriesColors;

/// Where the search for a free style begins: a sum over the letters (FNV-1a), the same on every
/// machine.
std::size_t preferred_style(std::string_view label) {
  const auto base = fixed_style(label.substr(0, label.find_first_of("+ ")));
  if (base) return (*base + kSeriesColors) % kPreferredStyles;
  std::uint32_t sum = 2166136261U;
  for (const char c : label) sum = (sum ^ static_cast<unsigned char>(c)) * 16777619U;
  return sum % kPreferredStyles;
}

}  // namespace

std::span<const double> dash_lengths(LinePattern pattern) {
  static constexpr std::array<double, 2> kDashed = {8.0, 4.0};
  static constexpr std::array<double, 4> kDashDotted = {9.0, 3.0, 2.0, 3.0};
  static constexpr std::array<double, 2> kDotted = {3.0, 3.0};
  if (pattern == LinePattern::kDashed) return kDashed;
  if (pattern == LinePattern::kDashDotted) return kDashDotted;
  if (pattern == LinePattern::kDotted) return kDotted;
  return {};
}

SeriesStyle series_style(std::size_t index) {
  const std::size_t style = index % kSeriesStyles;
  const auto& [light, dark] = kColors[style % kSeriesColors];
  const std::size_t turn = style / kSeriesColors;
  return {light, dark, kPatterns[(style + turn) % kPatterns.size()]};
}

std::vector<std::size_t> series_styles(std::span<const std::string> labels) {
  std::vector<bool> taken(kSeriesStyles, false);
  std::vector<std::size_t> styles(labels.size());
  for (std::size_t i = 0; i < labels.size(); ++i) {
    if (const auto style = fixed_style(labels[i])) taken[styles[i] = *style] = true;
  }
  for (std::size_t i = 0; i < labels.size(); ++i) {
    if (fixed_style(labels[i])) continue;
    std::size_t style = preferred_style(labels[i]);
    for (std::size_t n = 1; n < kSeriesStyles && taken[style]; ++n) {
      style = (style + 1) % kSeriesStyles;
    }
    taken[styles[i] = style] = true;
  }
  return styles;
}

}  // namespace aims
