// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

#include "render/plots/image.hpp"
#include "tests/support/temporary_folder.hpp"

namespace aims::test {

/// A temporary folder for the pictures of one test case.
class PictureFolder {
 public:
  std::filesystem::path operator/(const std::string& name) const { return path() / name; }
  const std::filesystem::path& path() const { return folder_.path(); }
  std::size_t files() const;  ///< how many it holds

 private:
  TemporaryFolder folder_;
};

/// Pixels of a PNG file; an empty image when it is none.
Image read_png(const std::filesystem::path& path);

/// The colour of style `index` of series on white, or of the series `label` alone.
std::array<int, 3> colour_of(std::size_t index);
std::array<int, 3> colour_of(std::string_view label);

/// How many pixels from that column on are not white: of what is cut at the right edge.
int ink_right_of(const Image& image, int column);

/// How many pixels have that colour, within
/// `tolerance` per component.
int count_pixels(const Image& image, const std::array<int, 3>& color, int tolerance = 12);

}  // namespace aims::test
