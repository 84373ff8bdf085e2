// SPDX-License-Identifier: BSD-3-Clause
#include "render/film/apng.hpp"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string_view>
#include <vector>

#include "render/film/color_table.hpp"

namespace aims {
namespace {

constexpr std::uint8_t kStays = 0;  ///< number of the transparent colour: the pixel before stays
constexpr int kMostColors = 255;    ///< besides it
constexpr int kSampledFrames = 24;  ///< whose colours are counted

enum class Blend : std::uint8_t { kReplace = 0, kOver = 1 };

using Numbers = std::vector<std::uint8_t>;  ///< of colours, row by row

void put(std::string& bytes, std::uint32_t value) {
  for (const int shift : {24, 16, 8, 0}) bytes += static_cast<char>(value >> shift & 0xFFU);
}

void put16(std::string& bytes, std::uint32_t value) {
  for (const int shift : {8, 0}) bytes += static_cast<char>(value >> shift & 0xFFU);
}

void put_chunk(std::string& file, std::string_view type, std::string_view data) {
  put(file, static_cast<std::uint32_t>(data.size()));
  const std::size_t begin = file.size();
  file += type;
  file += data;
  const auto* checked = reinterpret_cast<const Bytef*>(file.data() + begin);
  put(file, static_cast<std::uint32_t>(
                crc32(crc32(0, nullptr, 0), checked, static_cast<uInt>(file.size() - begin))));
}

std::string compressed(const std::string& rows) {
  uLongf size = compressBound(rows.size());
  std::string result(size, '\0');
  compress2(reinterpret_cast<Bytef*>(result.data()), &size,
            reinterpret_cast<const Bytef*>(rows.data()), rows.size(), Z_BEST_COMPRESSION);
  result.resize(size);
  return result;
}

/// Part of a picture [px].
struct Patch {
  int x = 0;
  int y = 0;
  int width = 1;
  int height = 1;
};

/// The least patch outside which two frames agree; one pixel when they agree everywhere.
Patch changed_patch(const Numbers& before, const Numbers& now, int width, int height) {
  int left = width;
  int right = -1;
  int top = height;
  int bottom = -1;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const std::size_t i = static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                            static_cast<std::size_t>(x);
      if (before[i] == now[i]) continue;
      left = std::min(left, x);
      right = std::max(right, x);
      top = std::min(top, y);
      bottom = y;
    }
  }
  if (right < 0) return {};
  return {left, top, right - left + 1, bottom - top + 1};
}

/// Rows of a patch, each led by its filter, which is none; with `before`, what agrees with it is
/// left transparent.
std::string rows_of(const Numbers& now, const Numbers* before, int width, const Patch& patch) {
  std::string rows;
  rows.reserve(static_cast<std::size_t>(patch.height) * static_cast<std::size_t>(patch.width + 1));
  for (int y = patch.y; y < patch.y + patch.height; ++y) {
    rows += '\0';
    for (int x = patch.x; x < patch.x + patch.width; ++x) {
      const std::size_t i = static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                            static_cast<std::size_t>(x);
      const bool stays = before != nullptr && (*before)[i] == now[i];
      rows += static_cast<char>(stays ? kStays : now[i]);
    }
  }
  return rows;
}

class ApngWriter {
 public:
  ApngWriter(const Movie& movie, ColorTable table) : movie_(movie), table_(std::move(table)) {
    file_ = "\x89PNG\r\n\x1a\n";
    std::string header;
    put(header, static_cast<std::uint32_t>(movie.width));
    put(header, static_cast<std::uint32_t>(movie.height));
    header += std::string("\x08\x03\x00\x00\x00", 5);  // 8 bits, palette, no interlace
    put_chunk(file_, "IHDR", header);
    std::string control;
    put(control, static_cast<std::uint32_t>(movie.frames));
    put(control, 0);  // plays: without end
    put_chunk(file_, "acTL", control);
    std::string palette(3, '\0');  // kStays
    for (const auto& color : table_.colors()) {
      for (const std::uint8_t value : color) palette += static_cast<char>(value);
    }
    put_chunk(file_, "PLTE", palette);
    put_chunk(file_, "tRNS", std::string(1, '\0'));
  }

  void add(const Image& picture) {
    Numbers now = table_.numbers(picture);
    for (std::uint8_t& number : now) ++number;  // kStays comes first
    if (frame_ == 0) {
      add_frame(
          {0, 0, movie_.width, movie_.height}, Blend::kReplace,
          compressed(rows_of(now, nullptr, movie_.width, {0, 0, movie_.width, movie_.height})));
    } else {
      const Patch patch = changed_patch(before_, now, movie_.width, movie_.height);
      const std::string whole = compressed(rows_of(now, nullptr, movie_.width, patch));
      const std::string changes = compressed(rows_of(now, &before_, movie_.width, patch));
      const bool smaller = changes.size() < whole.size();
      add_frame(patch, smaller ? Blend::kOver : Blend::kReplace, smaller ? changes : whole);
    }
    before_ = std::move(now);
    ++frame_;
  }

  std::string finish() {
    put_chunk(file_, "IEND", {});
    return std::move(file_);
  }

 private:
  void add_frame(const Patch& patch, Blend blend, const std::string& data) {
    const bool last = frame_ + 1 == movie_.frames;
    const double stays_s = last ? movie_.last_frame_s : 1.0 / movie_.frame_rate;
    std::string control;
    put(control, sequence_++);
    for (const int value : {patch.width, patch.height, patch.x, patch.y}) {
      put(control, static_cast<std::uint32_t>(value));
    }
    put16(control, static_cast<std::uint32_t>(std::clamp(std::lround(1e3 * stays_s), 1L, 65535L)));
    put16(control, 1000);
    control += '\0';  // leaves its pixels to the next frame
    control += static_cast<char>(blend);
    put_chunk(file_, "fcTL", control);
    if (frame_ == 0) return put_chunk(file_, "IDAT", data);
    std::string numbered;
    put(numbered, sequence_++);
    put_chunk(file_, "fdAT", numbered + data);
  }

  const Movie& movie_;
  ColorTable table_;
  std::string file_;
  Numbers before_;
  int frame_ = 0;
  std::uint32_t sequence_ = 0;
};

Result<Image> drawn(const Movie& movie, int frame) {
  auto picture = movie.draw(frame);
  if (picture && (picture->width != movie.width || picture->height != movie.height)) {
    return failure(fmt::format("frame {} has {} x {} pixels, the movie {} x {}", frame,
                               picture->width, picture->height, movie.width, movie.height));
  }
  return picture;
}

}  // namespace

Result<std::string> apng_bytes(const Movie& movie) {
  if (movie.frames < 1 || movie.width < 1 || movie.height < 1) {
    return failure("a movie needs at least one frame of one pixel");
  }
  ColorCount count;
  const int samples = std::min(movie.frames, kSampledFrames);
  for (int i = 0; i < samples; ++i) {
    // Evenly from the first frame to the last.
    const auto picture = drawn(movie, samples < 2 ? 0 : i * (movie.frames - 1) / (samples - 1));
    if (!picture) return tl::unexpected(picture.error());
    count.add(*picture);
  }
  ApngWriter writer(movie, count.table(kMostColors));
  for (int frame = 0; frame < movie.frames; ++frame) {
    const auto picture = drawn(movie, frame);
    if (!picture) return tl::unexpected(picture.error());
    writer.add(*picture);
  }
  return writer.finish();
}

}  // namespace aims
