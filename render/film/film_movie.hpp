// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "render/film/film.hpp"
#include "render/film/movie.hpp"

namespace aims {

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
