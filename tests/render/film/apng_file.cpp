// SPDX-License-Identifier: BSD-3-Clause
#include "tests/render/film/apng_file.hpp"

#include <cairo.h>
#include <zlib.h>

#include <algorithm>
#include <cstring>

namespace aims::test {
namespace {

constexpr std::size_t kSignature = 8;

std::uint32_t number(const std::string& bytes, std::size_t at, int size = 4) {
  std::uint32_t value = 0;
  for (int i = 0; i < size; ++i) {
    value = value << 8 | static_cast<unsigned char>(bytes.at(at + static_cast<std::size_t>(i)));
  }
  return value;
}

std::string text(std::uint32_t value) {
  std::string bytes;
  for (const int shift : {24, 16, 8, 0}) bytes += static_cast<char>(value >> shift & 0xFFU);
  return bytes;
}

std::uint32_t checksum(const std::string& bytes) {
  return static_cast<std::uint32_t>(
      crc32(0, reinterpret_cast<const Bytef*>(bytes.data()), static_cast<uInt>(bytes.size())));
}

std::string chunk(const std::string& type, const std::string& data) {
  return text(static_cast<std::uint32_t>(data.size())) + type + data + text(checksum(type + data));
}

struct Reader {
  const std::string* bytes;
  std::size_t at;
};

cairo_status_t read_some(void* closure, unsigned char* data, unsigned int length) {
  auto* reader = static_cast<Reader*>(closure);
  if (reader->at + length > reader->bytes->size()) return CAIRO_STATUS_READ_ERROR;
  std::memcpy(data, reader->bytes->data() + reader->at, length);
  reader->at += length;
  return CAIRO_STATUS_SUCCESS;
}

/// One patch and where it goes.
struct Patch {
  int x = 0, y = 0, width = 0, height = 0;
  bool over = false;
  std::string data;
};

/// What only the whole file knows.
struct Common {
  std::string header, colors, transparency;
};

/// Puts the patch, decoded as a PNG of its own, onto `canvas`.
bool compose(const Common& common, const Patch& patch, Image& canvas) {
  const std::string png =
      "\x89PNG\r\n\x1a\n" +
      chunk("IHDR", text(static_cast<std::uint32_t>(patch.width)) +
                        text(static_cast<std::uint32_t>(patch.height)) + common.header.substr(8)) +
      chunk("PLTE", common.colors) + chunk("tRNS", common.transparency) +
      chunk("IDAT", patch.data) + chunk("IEND", "");
  Reader reader{&png, 0};
  cairo_surface_t* surface = cairo_image_surface_create_from_png_stream(read_some, &reader);
  const bool good = cairo_surface_status(surface) == CAIRO_STATUS_SUCCESS;
  const unsigned char* data = good ? cairo_image_surface_get_data(surface) : nullptr;
  for (int row = 0; good && row < patch.height; ++row) {
    const unsigned char* line = data + row * cairo_image_surface_get_stride(surface);
    for (int column = 0; column < patch.width; ++column) {
      const unsigned char* bgra = line + 4 * column;
      if (patch.over && bgra[3] == 0) continue;
      canvas.set(patch.x + column, patch.y + row, {bgra[2], bgra[1], bgra[0]});
    }
  }
  cairo_surface_destroy(surface);
  return good;
}

class Parser {
 public:
  explicit Parser(const std::string& bytes) : bytes_(bytes) {}

  ApngFile parse() {
    if (bytes_.compare(0, kSignature, "\x89PNG\r\n\x1a\n") != 0) return failed("no PNG");
    std::string type;
    for (std::size_t at = kSignature; at < bytes_.size() && type != "IEND";) {
      const std::size_t length = number(bytes_, at);
      if (at + 12 + length > bytes_.size()) return failed("cut short");
      type = bytes_.substr(at + 4, 4);
      const std::string data = bytes_.substr(at + 8, length);
      if (checksum(type + data) != number(bytes_, at + 8 + length)) return failed("checksum");
      take(type, data);
      at += 12 + length;
    }
    if (type != "IEND") return failed("no end");
    finish_frame();
    return std::move(file_);
  }

 private:
  ApngFile failed(const std::string& fault) {
    file_.fault = fault;
    return std::move(file_);
  }

  void in_sequence(const std::string& data) {
    if (number(data, 0) != sequence_++) file_.fault = "sequence numbers";
  }

  void take(const std::string& type, const std::string& data) {
    if (type == "IHDR") {
      common_.header = data;
      canvas_ = Image(static_cast<int>(number(data, 0)), static_cast<int>(number(data, 4)));
    } else if (type == "acTL") {
      file_.declared_frames = static_cast<int>(number(data, 0));
      file_.plays = static_cast<int>(number(data, 4));
    } else if (type == "PLTE") {
      common_.colors = data;
    } else if (type == "tRNS") {
      common_.transparency = data;
    } else if (type == "fcTL") {
      finish_frame();
      in_sequence(data);
      start_frame(data);
    } else if (type == "IDAT") {
      patch_.data += data;
    } else if (type == "fdAT") {
      in_sequence(data);
      patch_.data += data.substr(4);
    }
  }

  void start_frame(const std::string& data) {
    patch_ = {static_cast<int>(number(data, 12)),
              static_cast<int>(number(data, 16)),
              static_cast<int>(number(data, 4)),
              static_cast<int>(number(data, 8)),
              data.at(25) == 1,
              ""};
    const bool inside = patch_.width > 0 && patch_.height > 0 &&
                        patch_.x + patch_.width <= canvas_.width &&
                        patch_.y + patch_.height <= canvas_.height;
    if (!inside) file_.fault = "a frame outside the picture";
    if (data.at(24) != 0) file_.fault = "another disposal than none";
    file_.stays_s.push_back(static_cast<double>(number(data, 20, 2)) / number(data, 22, 2));
    started_ = true;
  }

  void finish_frame() {
    if (!started_ || !file_.fault.empty()) return;
    if (!compose(common_, patch_, canvas_)) file_.fault = "libpng refuses a frame";
    file_.frames.push_back(canvas_);
    file_.patch_pixels.push_back(static_cast<std::size_t>(patch_.width) *
                                 static_cast<std::size_t>(patch_.height));
    started_ = false;
  }

  const std::string& bytes_;
  ApngFile file_;
  Common common_;
  Patch patch_;
  Image canvas_;
  std::uint32_t sequence_ = 0;
  bool started_ = false;
};

}  // namespace

ApngFile read_apng(const std::string& bytes) { return Parser(bytes).parse(); }

}  // namespace aims::test
