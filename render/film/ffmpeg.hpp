// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>

#include "core/error.hpp"
#include "render/film/film_movie.hpp"

namespace aims {

/// The program `ffmpeg`, by PATH; none when it is not there.
std::optional<std::filesystem::path> find_ffmpeg();

/// Writes the movie as H.264 in .mp4 or VP9 in .webm by handing its frames to ffmpeg; the file
/// appears complete or not at all. Width and height must be even. Error with ffmpeg's message when
/// it fails, and for another ending.
Result<void> write_with_ffmpeg(const std::filesystem::path& ffmpeg,
                               const std::filesystem::path& file, const Movie& movie);

}  // namespace aims
