// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "render/plots/image.hpp"

namespace aims::test {

/// An animated WebP as a viewer shows it.
struct WebpFile {
  int loops = -1;                 ///< 0: without end
  std::vector<Image> frames;      ///< composed
  std::vector<int> durations_ms;  ///< of each frame
};

/// Decodes every frame with libwebpdemux; no frames when the bytes are no animated WebP.
WebpFile read_webp(const std::string& bytes);

}  // namespace aims::test
