// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>

#include "core/error.hpp"
#include "render/film/film.hpp"
#include "render/plots/image.hpp"

namespace aims {

/// Pictures of one size that follow one another. The last one stays, and then the first returns.
struct Movie {
  int width = 640;            ///< [px]
  int height = 400;           ///< [px]
  int frames = 1;             ///< at least one
  double frame_rate = 12.0;   ///< [Hz]
  double last_frame_s = 1.0;  ///< that the last one stays [s]
  /// Draws a frame, 0 to `frames` - 1. The same number gives the same picture, in any order.
  std::function<Result<Image>(int frame)> draw;
};

/// When the film begins and ends: from the first step to the last.
struct FilmSpan {
  Time begin = 0;
  Time end = 0;
};
FilmSpan motion_span(const FilmedSequence& sequence);

/// The whole sequence in `seconds`, `frame_rate` pictures each; `film` must outlive the movie.
Movie movie_of(Film& film, const FilmSpan& span, const FilmConfig& config, double seconds,
               double frame_rate);

}  // namespace aims
