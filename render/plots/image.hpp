// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace aims {

/// Picture of 8-bit RGB pixels, row by row from the top.
struct Image {
  int width = 0;   ///< [px]
  int height = 0;  ///< [px]
  std::vector<std::uint8_t> rgb;

  Image() = default;
  Image(int columns, int rows)
      : width(columns),
        height(rows),
        rgb(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows) * 3) {}

  /// Index of the pixel's red value in `rgb`.
  std::size_t at(int column, int row) const {
    return 3 * (static_cast<std::size_t>(row) * static_cast<std::size_t>(width) +
                static_cast<std::size_t>(column));
  }
  std::array<std::uint8_t, 3> pixel(int column, int row) const {
    const std::size_t i = at(column, row);
    return {rgb[i], rgb[i + 1], rgb[i + 2]};
  }
  void set(int column, int row, const std::array<std::uint8_t, 3>& color) {
    const std::size_t i = at(column, row);
    for (std::size_t c = 0; c < 3; ++c) rgb[i + c] = color[c];
  }
};

}  // namespace aims
