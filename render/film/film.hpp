// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "core/error.hpp"
#include "render/film/filmed_sequence.hpp"
#include "render/film/movie.hpp"
#include "render/plots/image.hpp"

namespace aims {

/// Where the camera is.
enum class FilmView {
  kFollow,  ///< behind and above the robot, looking along the way out
  kTop,     ///< straight above it
};

/// How pictures of a walk look.
struct FilmConfig {
  int width = 640;   ///< [px]
  int height = 400;  ///< [px]
  FilmView view = FilmView::kFollow;
  bool still = false;  ///< nearer and finer than the pictures of a video
};

/// Draws a walk at any instant: the robot where it truly is, the map as far as it had grown, the
/// way so far by truth and by estimate, and a plan of the whole with both below. One at a time per
/// thread.
class Film {
 public:
  /// Keeps a reference to `walk`. Error without snapshots or when there is no OpenGL context.
  static Result<Film> create(const FilmedSequence& sequence, const FilmConfig& config);
  Film(Film&&) noexcept;
  Film& operator=(Film&&) noexcept;
  ~Film();

  /// Of the snapshot nearest to `stamp`.
  Result<Image> picture(Time stamp);

  /// Points of the map that a picture at `stamp` shows.
  std::size_t points_shown(Time stamp) const;

 private:
  struct Impl;
  explicit Film(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

/// When the film begins and ends: from the first step to the last.
struct FilmSpan {
  Time begin = 0;
  Time end = 0;
};
FilmSpan walking_span(const FilmedSequence& sequence);

/// The whole walk in `seconds`, `frame_rate` pictures each; `film` must outlive the movie.
Movie movie_of(Film& film, const FilmSpan& span, const FilmConfig& config, double seconds,
               double frame_rate);

}  // namespace aims
