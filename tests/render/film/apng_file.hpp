// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "render/plots/image.hpp"

namespace aims::test {

/// An animated PNG as a viewer shows it.
struct ApngFile {
  std::string fault;          ///< what is wrong with the file; empty: nothing
  int declared_frames = 0;    ///< by acTL
  int plays = -1;             ///< by acTL; 0: without end
  std::vector<Image> frames;  ///< composed
  std::vector<double> stays_s;
  std::vector<std::size_t> patch_pixels;  ///< that each frame writes
};

/// Takes the file apart by its chunks, checks their order and checksums, has libpng (by cairo)
/// decode each frame as a PNG of its own, and composes them as the specification says.
ApngFile read_apng(const std::string& bytes);

}  // namespace aims::test
