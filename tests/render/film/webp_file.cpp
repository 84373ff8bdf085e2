// SPDX-License-Identifier: BSD-3-Clause
#include "tests/render/film/webp_file.hpp"

#include <webp/demux.h>

#include <cstdint>
#include <memory>

namespace aims::test {
namespace {

Image opaque(const std::uint8_t* rgba, int width, int height) {
  Image image(width, height);
  for (std::size_t i = 0; i < image.rgb.size() / 3; ++i) {
    for (std::size_t c = 0; c < 3; ++c) image.rgb[3 * i + c] = rgba[4 * i + c];
  }
  return image;
}

}  // namespace

WebpFile read_webp(const std::string& bytes) {
  const WebPData data{reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()};
  const std::unique_ptr<WebPAnimDecoder, void (*)(WebPAnimDecoder*)> decoder(
      WebPAnimDecoderNew(&data, nullptr), WebPAnimDecoderDelete);
  WebPAnimInfo info;
  if (!decoder || WebPAnimDecoderGetInfo(decoder.get(), &info) == 0) return {};
  WebpFile file;
  file.loops = static_cast<int>(info.loop_count);
  int begin_ms = 0;
  while (WebPAnimDecoderHasMoreFrames(decoder.get()) != 0) {
    std::uint8_t* rgba = nullptr;
    int end_ms = 0;
    if (WebPAnimDecoderGetNext(decoder.get(), &rgba, &end_ms) == 0) return {};
    file.frames.push_back(
        opaque(rgba, static_cast<int>(info.canvas_width), static_cast<int>(info.canvas_height)));
    file.durations_ms.push_back(end_ms - begin_ms);
    begin_ms = end_ms;
  }
  return file;
}

}  // namespace aims::test
