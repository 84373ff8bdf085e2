// SPDX-License-Identifier: BSD-3-Clause
#include "render/film/color_table.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

namespace aims {
namespace {

using Rgb = ColorTable::Rgb;

/// A colour and how much it matters. The root of its share of the pixels, so that a thin line's
/// colour holds its own against a large background.
struct WeightedColor {
  Rgb rgb{};
  double weight = 0.0;
};

struct Box {
  std::span<WeightedColor> colors;
  std::size_t axis = 0;  ///< along which the box is widest
  double urgency = 0.0;  ///< its width there, weighted
};

Box box_around(std::span<WeightedColor> colors) {
  Box box{colors, 0, 0.0};
  double weight = 0.0;
  for (const WeightedColor& each : colors) weight += each.weight;
  int widest = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto [low, high] = std::minmax_element(
        colors.begin(), colors.end(),
        [axis](const auto& a, const auto& b) { return a.rgb[axis] < b.rgb[axis]; });
    const int width = high->rgb[axis] - low->rgb[axis];
    if (width <= widest) continue;
    widest = width;
    box.axis = axis;
  }
  box.urgency = widest * std::sqrt(weight);
  return box;
}

/// Two boxes, each with about half of the weight and at least one colour.
std::array<Box, 2> halves(const Box& box) {
  std::sort(box.colors.begin(), box.colors.end(), [&](const auto& a, const auto& b) {
    if (a.rgb[box.axis] != b.rgb[box.axis]) return a.rgb[box.axis] < b.rgb[box.axis];
    return a.rgb < b.rgb;
  });
  double total = 0.0;
  for (const WeightedColor& each : box.colors) total += each.weight;
  double below = 0.0;
  std::size_t cut = 0;
  while (cut + 1 < box.colors.size() && (cut == 0 || below < 0.5 * total)) {
    below += box.colors[cut++].weight;
  }
  return {box_around(box.colors.first(cut)), box_around(box.colors.subspan(cut))};
}

Rgb mean_of(const Box& box) {
  std::array<double, 3> sum{};
  double weight = 0.0;
  for (const WeightedColor& each : box.colors) {
    for (std::size_t c = 0; c < 3; ++c) sum[c] += each.weight * each.rgb[c];
    weight += each.weight;
  }
  Rgb mean{};
  for (std::size_t c = 0; c < 3; ++c) {
    mean[c] = static_cast<std::uint8_t>(std::lround(sum[c] / weight));
  }
  return mean;
}

}  // namespace

std::size_t ColorTable::cell_of(const std::uint8_t* rgb) {
  std::size_t cell = 0;
  for (int c = 0; c < 3; ++c)
    cell = (cell << kBits) | static_cast<std::size_t>(rgb[c] >> (8 - kBits));
  return cell;
}

std::uint8_t ColorTable::nearest(const Rgb& color) const {
  int least = std::numeric_limits<int>::max();
  std::size_t best = 0;
  for (std::size_t i = 0; i < colors_.size(); ++i) {
    int distance = 0;
    for (std::size_t c = 0; c < 3; ++c) {
      const int apart = int{colors_[i][c]} - int{color[c]};
      distance += apart * apart;
    }
    if (distance >= least) continue;
    least = distance;
    best = i;
  }
  return static_cast<std::uint8_t>(best);
}

std::vector<std::uint8_t> ColorTable::numbers(const Image& picture) {
  std::vector<std::uint8_t> result(picture.rgb.size() / 3);
  for (std::size_t i = 0; i < result.size(); ++i) {
    const std::uint8_t* rgb = &picture.rgb[3 * i];
    std::int16_t& known = nearest_[cell_of(rgb)];
    if (known < 0) {
      Rgb middle{};
      for (std::size_t c = 0; c < 3; ++c) {
        middle[c] =
            static_cast<std::uint8_t>((rgb[c] >> (8 - kBits) << (8 - kBits)) | (1 << (7 - kBits)));
      }
      known = nearest(middle);
    }
    result[i] = static_cast<std::uint8_t>(known);
  }
  return result;
}

void ColorCount::add(const Image& picture) {
  for (std::size_t i = 0; i + 2 < picture.rgb.size(); i += 3) {
    Cell& cell = cells_[ColorTable::cell_of(&picture.rgb[i])];
    ++cell.count;
    for (std::size_t c = 0; c < 3; ++c) cell.sum[c] += picture.rgb[i + c];
  }
}

ColorTable ColorCount::table(int most) const {
  std::vector<WeightedColor> colors;
  for (const Cell& cell : cells_) {
    if (cell.count == 0) continue;
    WeightedColor color{{}, std::sqrt(static_cast<double>(cell.count))};
    for (std::size_t c = 0; c < 3; ++c) {
      color.rgb[c] = static_cast<std::uint8_t>((cell.sum[c] + cell.count / 2) / cell.count);
    }
    colors.push_back(color);
  }
  if (colors.empty()) return ColorTable({Rgb{}});
  std::vector<Box> boxes = {box_around(colors)};
  while (boxes.size() < static_cast<std::size_t>(most)) {
    const auto widest =
        std::max_element(boxes.begin(), boxes.end(),
                         [](const Box& a, const Box& b) { return a.urgency < b.urgency; });
    if (widest->urgency <= 0.0) break;
    const auto [first, second] = halves(*widest);
    *widest = first;
    boxes.push_back(second);
  }
  std::vector<Rgb> table;
  for (const Box& box : boxes) table.push_back(mean_of(box));
  std::sort(table.begin(), table.end());
  return ColorTable(std::move(table));
}

}  // namespace aims
