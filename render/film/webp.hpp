// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "core/error.hpp"
#include "render/film/film_movie.hpp"

namespace aims {

/// The movie as an animated WebP, looped without end. A frame equal to the previous one only
/// prolongs it. The same movie gives the same bytes. Error without frames, for a frame of another
/// size, or when a frame cannot be drawn or encoded.
Result<std::string> webp_bytes(const Movie& movie);

}  // namespace aims
