// SPDX-License-Identifier: BSD-3-Clause
#include "tests/render/plots/picture_file.hpp"

#include <cairo.h>

#include <algorithm>
#include <cstdlib>
#include <iterator>
#include <string>
#include <vector>

#include "core/series_style.hpp"

namespace aims::test {

std::size_t PictureFolder::files() const {
  return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(path()), {}));
}

Image read_png(const std::filesystem::path& path) {
  cairo_surface_t* surface = cairo_image_surface_create_from_png(path.c_str());
  Image image;
  if (cairo_surface_status(surface) == CAIRO_STATUS_SUCCESS) {
    image = Image(cairo_image_surface_get_width(surface), cairo_image_surface_get_height(surface));
    const unsigned char* data = cairo_image_surface_get_data(surface);
    const int stride = cairo_image_surface_get_stride(surface);
    for (int row = 0; row < image.height; ++row) {
      for (int column = 0; column < image.width; ++column) {
        const unsigned char* bgr = data + static_cast<std::ptrdiff_t>(row) * stride + 4 * column;
        image.set(column, row, {bgr[2], bgr[1], bgr[0]});
      }
    }
  }
  cairo_surface_destroy(surface);
  return image;
}

int ink_right_of(const Image& image, int column) {
  int count = 0;
  for (int row = 0; row < image.height; ++row) {
    for (int x = std::max(0, column); x < image.width; ++x) {
      count += image.pixel(x, row) != std::array<std::uint8_t, 3>{255, 255, 255} ? 1 : 0;
    }
  }
  return count;
}

std::array<int, 3> colour_of(std::size_t index) {
  const auto rgb = static_cast<int>(series_style(index).light);
  return {rgb >> 16 & 0xFF, rgb >> 8 & 0xFF, rgb & 0xFF};
}

std::array<int, 3> colour_of(std::string_view label) {
  return colour_of(series_styles(std::vector<std::string>{std::string(label)}).front());
}

int count_pixels(const Image& image, const std::array<int, 3>& color, int tolerance) {
  int count = 0;
  for (int row = 0; row < image.height; ++row) {
    for (int column = 0; column < image.width; ++column) {
      const auto pixel = image.pixel(column, row);
      bool near = true;
      for (std::size_t c = 0; c < 3; ++c) near = near && std::abs(pixel[c] - color[c]) <= tolerance;
      count += near ? 1 : 0;
    }
  }
  return count;
}

}  // namespace aims::test
