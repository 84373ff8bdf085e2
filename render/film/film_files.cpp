// SPDX-License-Identifier: BSD-3-Clause
#include "render/film/film_files.hpp"

#include <fmt/format.h>

#include <cmath>

#include "bench/scoring/json_text.hpp"
#include "core/file_name.hpp"
#include "core/files/atomic_file.hpp"
#include "core/files/output_folder.hpp"
#include "core/text.hpp"
#include "render/film/ffmpeg.hpp"
#include "render/film/film_movie.hpp"
#include "render/film/filmed_sequence.hpp"
#include "render/film/webp.hpp"
#include "render/plots/canvas.hpp"
#include "render/plots/map_picture.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;
constexpr const char* kStartAligned = "estimates aligned by their start alone";

TrajectoryPlot trajectories_of(const FilmedSequence& sequence) {
  TrajectoryPlot plot;
  plot.title = sequence.scenario + ": estimated trajectories";
  plot.subtitle = fmt::format("seed {}  ·  {}", sequence.seed, kStartAligned);
  plot.scene = sequence.scene;
  plot.truth = sequence.truth;
  plot.estimates = sequence.estimates;
  plot.waypoint_times = sequence.waypoint_times;
  return plot;
}

MapPicture map_of(const FilmedSequence& sequence) {
  MapPicture map;
  map.title = fmt::format("{}: map of {}", sequence.scenario, sequence.estimates.front().name);
  map.frame = "aligned with the truth at the start";
  for (const GrownPoint& point : sequence.map) map.points.push_back(point.position);
  map.trajectory = sequence.estimates.front().trajectory;
  return map;
}

/// Writes trajectories, and NAME-map-top and NAME-map-side when there is a map, each with each of
/// the endings (".svg", ".pdf"). Returns the names of the files.
Result<std::vector<std::string>> write_vector_pictures(const FilmedSequence& sequence,
                                                       const std::vector<std::string>& endings,
                                                       const std::filesystem::path& folder) {
  std::vector<std::string> files;
  const TrajectoryPlot trajectories = trajectories_of(sequence);
  const bool mapped = !sequence.map.empty() && !sequence.estimates.empty();
  const MapPicture map = mapped ? map_of(sequence) : MapPicture{};
  const std::string name = mapped ? sequence.estimates.front().name : std::string();
  for (const std::string& ending : endings) {
    files.push_back("trajectories" + ending);
    auto written = write_trajectory_plot(folder / files.back(), trajectories);
    for (const auto& [view, suffix] :
         {std::pair{MapView::kAbove, "-map-top"}, {MapView::kSide, "-map-side"}}) {
      if (!mapped || !written) continue;
      files.push_back(name + suffix + ending);
      written = write_map_picture(folder / files.back(), view, map);
    }
    if (!written) return tl::unexpected(written.error());
  }
  return files;
}

constexpr int kMostFrames = 2000;
constexpr double kStillFraction = 0.75;  ///< of the time in motion, when the still is taken

enum class VideoKind { kWebp, kFfmpeg };

Result<VideoKind> kind_of(const std::string& video) {
  const fs::path file = video;
  if (file.has_parent_path()) {
    return failure(
        fmt::format("--video {}: expected a file name without a folder; --out gives "
                    "the folder",
                    video));
  }
  if (auto name = check_file_name("--video", video); !name) return tl::unexpected(name.error());
  const std::string ending = file.extension().string();
  if (ending == ".webp") return VideoKind::kWebp;
  if (ending == ".mp4" || ending == ".webm") return VideoKind::kFfmpeg;
  return failure(
      fmt::format("--video {}: expected a file name ending in .webp, .mp4 or .webm", video));
}

Result<void> write_still(const FilmedSequence& sequence, const FilmOptions& options,
                         const fs::path& file, Json& record) {
  const FilmConfig config{.width = options.still_size.width,
                          .height = options.still_size.height,
                          .view = options.view,
                          .still = true};
  auto film = Film::create(sequence, config);
  if (!film) return tl::unexpected(film.error());
  const FilmSpan span = motion_span(sequence);
  const double at = options.at_s.value_or(to_seconds(span.begin) +
                                          kStillFraction * to_seconds(span.end - span.begin));
  if (at < to_seconds(sequence.truth.front().stamp) ||
      at > to_seconds(sequence.truth.back().stamp)) {
    return failure(fmt::format(
        "--at {:g}: expected {:.1f} to {:.1f} s, the time span of the sequence", at,
        to_seconds(sequence.truth.front().stamp), to_seconds(sequence.truth.back().stamp)));
  }
  const auto picture = film->picture(from_seconds(at));
  if (!picture) return tl::unexpected(picture.error());
  auto canvas = Canvas::create(file, picture->width, picture->height);
  if (!canvas) return tl::unexpected(canvas.error());
  canvas->image(*picture, {0.0, 0.0, static_cast<double>(picture->width),
                           static_cast<double>(picture->height)});
  record["still"] = {{"file", file.filename().string()},
                     {"at_s", at},
                     {"map_points", film->points_shown(from_seconds(at))}};
  return canvas->finish();
}

/// The movie with an observer that is called before each frame and may end it.
Movie observed(const Movie& movie, const FrameObserver& observer) {
  Movie result = movie;
  result.draw = [draw = movie.draw, frames = movie.frames, observer](int frame) -> Result<Image> {
    if (!observer(frame, frames)) return failure("interrupted");
    return draw(frame);
  };
  return result;
}

Result<void> write_video(const FilmedSequence& sequence, const FilmOptions& options,
                         const fs::path& file, const FrameObserver& observer, Json& record) {
  const FilmConfig config{
      .width = options.video_size.width, .height = options.video_size.height, .view = options.view};
  auto film = Film::create(sequence, config);
  if (!film) return tl::unexpected(film.error());
  const FilmSpan span = motion_span(sequence);
  const Movie movie =
      observed(movie_of(*film, span, config, options.seconds, options.frame_rate), observer);
  record["video"] = {{"file", file.filename().string()},
                     {"frames", movie.frames},
                     {"frame_rate_hz", movie.frame_rate},
                     {"from_s", to_seconds(span.begin)},
                     {"to_s", to_seconds(span.end)},
                     {"map_points_first", film->points_shown(span.begin)},
                     {"map_points", film->points_shown(span.end)}};
  if (*kind_of(options.video) == VideoKind::kFfmpeg) {
    return write_with_ffmpeg(*find_ffmpeg(), file, movie);
  }
  const auto bytes = webp_bytes(movie);
  if (!bytes) return tl::unexpected(bytes.error());
  return write_file_atomically(file, *bytes);
}

Json record_of(const FilmedSequence& sequence) {
  Json record;
  record["schema"] = "aims.render/1";
  record["scenario"] = sequence.scenario;
  record["seed"] = sequence.seed;
  record["complete"] = sequence.complete;
  record["map_of"] = sequence.estimates.empty() ? Json() : Json(sequence.estimates.front().name);
  return record;
}

Result<std::vector<std::string>> write_all(const FilmedSequence& sequence,
                                           const FilmOptions& options,
                                           const FrameObserver& observer, const fs::path& folder) {
  std::vector<std::string> files;
  Json record = record_of(sequence);
  Result<void> written;
  if (options.still) {
    files.emplace_back("still.png");
    written = write_still(sequence, options, folder / files.back(), record);
  }
  if (written && !options.video.empty()) {
    files.push_back(options.video);
    written = write_video(sequence, options, folder / files.back(), observer, record);
  }
  if (!written) return tl::unexpected(written.error());
  std::vector<std::string> endings;
  if (options.svg) endings.emplace_back(".svg");
  if (options.pdf) endings.emplace_back(".pdf");
  const auto vectors = write_vector_pictures(sequence, endings, folder);
  if (!vectors) return tl::unexpected(vectors.error());
  files.insert(files.end(), vectors->begin(), vectors->end());
  record["files"] = files;
  written = write_json(folder / "render.json", record);
  if (!written) return tl::unexpected(written.error());
  return files;
}

}  // namespace

Result<PictureSize> parse_picture_size(const std::string& text) {
  std::string_view height = text;
  const PictureSize size{number_from<int>(take_until(height, 'x')).value_or(0),
                         number_from<int>(height).value_or(0)};
  if (size.width >= 160 && size.width <= 7680 && size.height >= 120 && size.height <= 4320) {
    return size;
  }
  return failure(fmt::format(
      "'{}': expected WIDTHxHEIGHT in pixels, from 160x120 to 7680x4320, e.g. 640x400", text));
}

Result<void> check(const FilmOptions& options) {
  if (options.video.empty()) return {};
  const auto kind = kind_of(options.video);
  if (!kind) return tl::unexpected(kind.error());
  if (options.still && options.video == "still.png") {
    return failure("--video still.png: that is the still; expected another name");
  }
  const double frames = options.seconds * options.frame_rate;
  if (!(frames >= 2.0 && frames <= kMostFrames)) {
    return failure(fmt::format("--seconds {:g} at --fps {:g} make {:g} frames; expected 2 to {}",
                               options.seconds, options.frame_rate, frames, kMostFrames));
  }
  if (*kind == VideoKind::kWebp) return {};
  if (options.video_size.width % 2 != 0 || options.video_size.height % 2 != 0) {
    return failure(fmt::format("--size {}x{}: expected even numbers for {}",
                               options.video_size.width, options.video_size.height,
                               fs::path(options.video).extension().string()));
  }
  if (!find_ffmpeg()) {
    return failure(
        fmt::format("--video {}: needs the program ffmpeg on PATH; a video that ends in "
                    ".webp needs none",
                    options.video));
  }
  return {};
}

Result<std::vector<fs::path>> write_film(const FilmedSequence& sequence, const FilmOptions& options,
                                         const FrameObserver& observer) {
  auto folder = OutputFolder::create(options.out, options.overwrite);
  if (!folder) return tl::unexpected(folder.error());
  const auto files = write_all(sequence, options, observer, folder->path());
  if (!files) return tl::unexpected(files.error());
  if (auto committed = folder->commit(); !committed) return tl::unexpected(committed.error());
  std::vector<fs::path> result;
  for (const std::string& file : *files) result.push_back(folder->final_path() / file);
  return result;
}

}  // namespace aims
