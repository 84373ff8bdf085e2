// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <string>

#include "render/image.hpp"

namespace aims::test {

/// Folder of its own for the running test case, empty at the start and removed at the end.
class PictureFolder {
 public:
  PictureFolder();
  PictureFolder(const PictureFolder&) = delete;
  PictureFolder& operator=(const PictureFolder&) = delete;
  ~PictureFolder();

  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }
  const std::filesystem::path& path() const { return path_; }
  std::size_t files() const;  ///< how many it holds

 private:
  std::filesystem::path path_;
};

/// Pixels of a PNG file; an empty image when it is none.
Image read_png(const std::filesystem::path& path);

/// How many pixels have that colour, within
/// `tolerance` per component.
int count_pixels(const Image& image, const std::array<int, 3>& color, int tolerance = 12);

}  // namespace aims::test
