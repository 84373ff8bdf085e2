// SPDX-License-Identifier: BSD-3-Clause
#include "render/film/webp.hpp"

#include <fmt/format.h>
#include <webp/encode.h>
#include <webp/mux.h>

#include <cmath>
#include <memory>
#include <utility>

namespace aims {
namespace {

using WebpEncoder = std::unique_ptr<WebPAnimEncoder, void (*)(WebPAnimEncoder*)>;

WebpEncoder encoder_of(const Movie& movie) {
  WebPAnimEncoderOptions options;
  WebPAnimEncoderOptionsInit(&options);
  options.anim_params.loop_count = 0;  // without end
  return {WebPAnimEncoderNew(movie.width, movie.height, &options), WebPAnimEncoderDelete};
}

/// Measured on 96 frames of 640 x 400 pixels of a corridor: 1.27 MB in 2.4 s. Lossless takes
/// 8.0 MB in 9.6 s; method 6 saves 4 % in 9 times the time. Without the sharp conversion the file
/// is 8 % smaller and the thin lines lose their colour.
WebPConfig encoding() {
  WebPConfig config;
  WebPConfigInit(&config);
  config.quality = 75.0F;
  config.method = 4;
  config.use_sharp_yuv = 1;
  return config;
}

Result<Image> drawn(const Movie& movie, int frame) {
  auto picture = movie.draw(frame);
  if (picture && (picture->width != movie.width || picture->height != movie.height)) {
    return failure(fmt::format("frame {} has {} x {} pixels, the movie {} x {}", frame,
                               picture->width, picture->height, movie.width, movie.height));
  }
  return picture;
}

Result<void> add(WebPAnimEncoder* encoder, const Image& image, int stamp_ms,
                 const WebPConfig& config) {
  WebPPicture picture;
  WebPPictureInit(&picture);
  picture.use_argb = 1;
  picture.width = image.width;
  picture.height = image.height;
  const bool added = WebPPictureImportRGB(&picture, image.rgb.data(), 3 * image.width) != 0 &&
                     WebPAnimEncoderAdd(encoder, &picture, stamp_ms, &config) != 0;
  WebPPictureFree(&picture);
  if (added) return {};
  return failure(fmt::format("libwebp: {}", WebPAnimEncoderGetError(encoder)));
}

Result<std::string> assembled(WebPAnimEncoder* encoder, int end_ms) {
  WebPData data;
  WebPDataInit(&data);
  if (WebPAnimEncoderAdd(encoder, nullptr, end_ms, nullptr) == 0 ||
      WebPAnimEncoderAssemble(encoder, &data) == 0) {
    return failure(fmt::format("libwebp: {}", WebPAnimEncoderGetError(encoder)));
  }
  std::string bytes(reinterpret_cast<const char*>(data.bytes), data.size);
  WebPDataClear(&data);
  return bytes;
}

}  // namespace

Result<std::string> webp_bytes(const Movie& movie) {
  if (movie.frames < 1 || movie.width < 1 || movie.height < 1) {
    return failure("a movie needs at least one frame of one pixel");
  }
  const WebpEncoder encoder = encoder_of(movie);
  if (!encoder) return failure("libwebp: no encoder");
  const WebPConfig config = encoding();
  const auto stamp_ms = [&](int frame) {
    return static_cast<int>(std::lround(1e3 * frame / movie.frame_rate));
  };
  for (int frame = 0; frame < movie.frames; ++frame) {
    const auto picture = drawn(movie, frame);
    if (!picture) return tl::unexpected(picture.error());
    if (auto added = add(encoder.get(), *picture, stamp_ms(frame), config); !added) {
      return tl::unexpected(added.error());
    }
  }
  const auto rest_ms = static_cast<int>(std::lround(1e3 * movie.last_frame_s));
  return assembled(encoder.get(), stamp_ms(movie.frames - 1) + rest_ms);
}

}  // namespace aims
