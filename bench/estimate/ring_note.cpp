// SPDX-License-Identifier: BSD-3-Clause
#include "bench/estimate/ring_note.hpp"

#include <fmt/format.h>

#include <cmath>

namespace aims {
namespace {

/// Relative difference of the angles between rings and rows that is no mismatch.
constexpr double kSpacingTolerance = 0.25;

bool fits(const LidarRings& image, const LidarRings& rings) {
  return image.count == rings.count &&
         std::abs(image.spacing_deg - rings.spacing_deg) <= kSpacingTolerance * rings.spacing_deg;
}

}  // namespace

std::string ring_note(std::string_view label, const Requirements& needs, const LidarRings& rings,
                      std::string_view source) {
  if (!needs.rings) return {};
  if (rings.count == 0) {
    return fmt::format("{} needs the ring of each point, which the {} lacks", label, source);
  }
  const LidarRings& image = needs.range_image;
  if (image.count == 0 || fits(image, rings)) return {};
  return fmt::format(
      "{} has a range image of {} rows {:.3g} deg apart, but the {} has {} rings {:.3g} deg apart: "
      "set its image.rows and image.row_angle_deg",
      label, image.count, image.spacing_deg, source, rings.count, rings.spacing_deg);
}

}  // namespace aims
