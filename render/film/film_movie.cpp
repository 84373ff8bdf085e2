// SPDX-License-Identifier: BSD-3-Clause
#include "render/film/film_movie.hpp"

#include <algorithm>
#include <cmath>

namespace aims {

FilmSpan motion_span(const FilmedSequence& sequence) {
  if (sequence.truth.empty()) return {};
  const auto away = [](const StampedPose& a, const StampedPose& b) {
    return (a.pose.translation - b.pose.translation).head<2>().norm() > 0.2;
  };
  FilmSpan span{sequence.truth.front().stamp, sequence.truth.back().stamp};
  for (const StampedPose& each : sequence.truth) {
    if (away(each, sequence.truth.front())) break;
    span.begin = each.stamp;
  }
  for (auto each = sequence.truth.rbegin(); each != sequence.truth.rend(); ++each) {
    if (away(*each, sequence.truth.back())) break;
    span.end = each->stamp;
  }
  if (span.end <= span.begin) span = {sequence.truth.front().stamp, sequence.truth.back().stamp};
  return span;
}

Movie movie_of(Film& film, const FilmSpan& span, const FilmConfig& config, double seconds,
               double frame_rate) {
  Movie movie;
  movie.width = config.width;
  movie.height = config.height;
  movie.frame_rate = frame_rate;
  movie.frames = std::max(2, static_cast<int>(std::lround(seconds * frame_rate)));
  const int last = movie.frames - 1;
  movie.draw = [&film, span, last](int frame) {
    const double fraction = static_cast<double>(frame) / last;
    return film.picture(span.begin +
                        std::llround(fraction * static_cast<double>(span.end - span.begin)));
  };
  return movie;
}

}  // namespace aims
