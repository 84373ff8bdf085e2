// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "core/error.hpp"
#include "render/film/filmed_sequence.hpp"
#include "render/plots/image.hpp"

namespace aims {

/// Where the camera is.
enum class FilmView {
  kFollow,  ///< behind and above the robot, looking in the outbound direction
  kTop,     ///< straight above it
};

/// How pictures of a sequence look.
struct FilmConfig {
  int width = 640;   ///< [px]
  int height = 400;  ///< [px]
  FilmView view = FilmView::kFollow;
  bool still = false;  ///< nearer and finer than the pictures of a video
};

/// Draws a sequence at any instant: the robot at its true pose, the map built so far, the true and
/// the estimated trajectory so far, and a plan of everything below. One at a time per
/// thread.
class Film {
 public:
  /// Keeps a reference to `sequence`. Error without snapshots or when there is no OpenGL context.
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

}  // namespace aims
