// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "bench/run/evaluate.hpp"
#include "bench/scenario/scenario.hpp"
#include "core/error.hpp"
#include "render/film/film.hpp"

namespace aims {

/// Width and height [px].
struct PictureSize {
  int width = 0;
  int height = 0;
};

/// "640x400": 160 to 7680 pixels wide, 120 to 4320 high. Error otherwise.
Result<PictureSize> parse_picture_size(const std::string& text);

/// What to draw of a sequence, and how.
struct FilmOptions {
  std::filesystem::path out;  ///< folder of the pictures
  bool overwrite = false;     ///< replace a folder of pictures that exists
  bool still = false;         ///< still.png
  std::string video;          ///< file name; its ending decides the format; empty: none
  bool svg = false;           ///< trajectories and maps
  bool pdf = false;           ///< the same
  PictureSize still_size{2400, 1350};
  PictureSize video_size{640, 400};
  FilmView view = FilmView::kFollow;
  double frame_rate = 12.0;  ///< of the video [Hz]
  double seconds = 8.0;      ///< length of the video [s]
  std::optional<double>
      at_s;  ///< instant of the still; none: after three quarters of the motion [s]

  bool needs_simulation() const { return still || !video.empty(); }
};

/// Error for options that cannot be met: a video of an unknown kind, with an odd size for ffmpeg,
/// of more than 2000 frames, or for an ffmpeg that is not there. To be asked before work starts.
Result<void> check(const FilmOptions& options);

/// Pictures of a video drawn so far; returning false ends it and nothing is written.
using FrameObserver = std::function<bool(int done, int frames)>;

/// Draws what `options` ask for and writes it, with render.json, which names scenario, seed and
/// files. Returns the files in order. Error when something cannot be drawn or written; then nothing
/// is left.
Result<std::vector<std::filesystem::path>> write_film(const FilmedSequence& sequence,
                                                      const FilmOptions& options,
                                                      const FrameObserver& observer);

}  // namespace aims
