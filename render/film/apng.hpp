// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "core/error.hpp"
#include "render/film/movie.hpp"

namespace aims {

/// The movie as the bytes of an animated PNG (PNG specification, third edition, W3C 2025, with
/// acTL, fcTL and fdAT chunks) that is repeated without end. All frames share one table of up to
/// 255 colours, picked from every few of them; pixels that stay are not written again. A viewer
/// that knows no animation shows the first frame. Error when a frame cannot be drawn or has another
/// size.
Result<std::string> apng_bytes(const Movie& movie);

}  // namespace aims
