// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "render/plots/image.hpp"

namespace aims {

/// A few colours that stand for all colours of some pictures.
class ColorTable {
 public:
  using Rgb = std::array<std::uint8_t, 3>;

  explicit ColorTable(std::vector<Rgb> colors) : colors_(std::move(colors)), nearest_(kCells, -1) {}

  const std::vector<Rgb>& colors() const { return colors_; }
  /// The number of the colour that is nearest to a pixel's, for every pixel row by row.
  std::vector<std::uint8_t> numbers(const Image& picture);

 private:
  friend class ColorCount;
  static constexpr int kBits = 5;  ///< of each component that tell colours apart
  static constexpr std::size_t kCells = std::size_t{1} << (3 * kBits);
  static std::size_t cell_of(const std::uint8_t* rgb);

  std::uint8_t nearest(const Rgb& color) const;

  std::vector<Rgb> colors_;
  std::vector<std::int16_t> nearest_;  ///< of each cell, once it was asked for
};

/// Counts the colours of pictures and picks those that serve best: median cut (P. Heckbert, Color
/// image quantization for frame buffer display, SIGGRAPH 1982).
class ColorCount {
 public:
  void add(const Image& picture);
  /// At most `most` (1 to 256) colours.
  ColorTable table(int most) const;

 private:
  struct Cell {
    std::uint64_t count = 0;
    std::array<std::uint64_t, 3> sum{};
  };
  std::vector<Cell> cells_ = std::vector<Cell>(ColorTable::kCells);
};

}  // namespace aims
