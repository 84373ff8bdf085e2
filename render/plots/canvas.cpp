// SPDX-License-Identifier: BSD-3-Clause
#include "render/plots/canvas.hpp"

#include <cairo-pdf.h>
#include <cairo-svg.h>
#include <cairo.h>

#include <cmath>
#include <numbers>
#include <span>
#include <system_error>
#include <utility>

#include "core/text.hpp"

namespace aims {
namespace {

struct SurfaceDeleter {
  void operator()(cairo_surface_t* surface) const { cairo_surface_destroy(surface); }
};
struct ContextDeleter {
  void operator()(cairo_t* context) const { cairo_destroy(context); }
};
using SurfacePtr = std::unique_ptr<cairo_surface_t, SurfaceDeleter>;
using ContextPtr = std::unique_ptr<cairo_t, ContextDeleter>;

void set_color(cairo_t* cr, const Color& color) {
  cairo_set_source_rgba(cr, color.red, color.green, color.blue, color.alpha);
}

void set_stroke(cairo_t* cr, const Stroke& stroke) {
  set_color(cr, stroke.color);
  cairo_set_line_width(cr, stroke.width);
  cairo_set_line_join(cr, CAIRO_LINE_JOIN_ROUND);
  const std::span<const double> dashes = dash_lengths(stroke.style);
  cairo_set_dash(cr, dashes.data(), static_cast<int>(dashes.size()), 0.0);
}

void set_font(cairo_t* cr, const TextStyle& style) {
  cairo_select_font_face(cr, "DejaVu Sans", CAIRO_FONT_SLANT_NORMAL,
                         style.bold ? CAIRO_FONT_WEIGHT_BOLD : CAIRO_FONT_WEIGHT_NORMAL);
  cairo_set_font_size(cr, style.size);
}

double fraction_of(Align align) {
  return align == Align::kStart ? 0.0 : (align == Align::kCenter ? 0.5 : 1.0);
}

SurfacePtr make_surface(const std::string& ending, const std::string& file, int width, int height) {
  if (ending == ".png")
    return SurfacePtr(cairo_image_surface_create(CAIRO_FORMAT_RGB24, width, height));
  if (ending == ".svg") return SurfacePtr(cairo_svg_surface_create(file.c_str(), width, height));
  SurfacePtr surface(cairo_pdf_surface_create(file.c_str(), width, height));
  // The same picture is the same file: without this cairo writes the time of day into it.
  cairo_pdf_surface_set_metadata(surface.get(), CAIRO_PDF_METADATA_CREATE_DATE, "");
  return surface;
}

std::string reason(cairo_status_t status) { return cairo_status_to_string(status); }

}  // namespace

struct Canvas::Impl {
  std::filesystem::path path;
  std::filesystem::path partial;  ///< written first, then renamed
  SurfacePtr surface;
  ContextPtr context;

  Impl() = default;
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;
  ~Impl() {
    context.reset();
    surface.reset();
    std::error_code ignored;
    if (!partial.empty()) std::filesystem::remove(partial, ignored);
  }
};

Canvas::Canvas(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Canvas::Canvas(Canvas&&) noexcept = default;
Canvas& Canvas::operator=(Canvas&&) noexcept = default;
Canvas::~Canvas() = default;

Result<Canvas> Canvas::create(const std::filesystem::path& path, int width, int height,
                              Color background) {
  const std::string ending = path.extension().string();
  if (ending != ".png" && ending != ".svg" && ending != ".pdf") {
    return failure(path.string() + ": expected a file name ending in .png, .svg or .pdf");
  }
  auto impl = std::make_unique<Impl>();
  impl->path = path;
  impl->partial = path.string() + ".part";
  impl->surface = make_surface(ending, impl->partial.string(), width, height);
  const cairo_status_t status = cairo_surface_status(impl->surface.get());
  if (status != CAIRO_STATUS_SUCCESS) {
    return failure(path.string() + ": cannot make a picture: " + reason(status));
  }
  impl->context.reset(cairo_create(impl->surface.get()));
  set_color(impl->context.get(), background);
  cairo_paint(impl->context.get());
  return Canvas(std::move(impl));
}

Canvas Canvas::over(const Image& picture) {
  auto impl = std::make_unique<Impl>();
  impl->surface.reset(
      cairo_image_surface_create(CAIRO_FORMAT_RGB24, picture.width, picture.height));
  impl->context.reset(cairo_create(impl->surface.get()));
  Canvas canvas(std::move(impl));
  canvas.image(picture,
               {0.0, 0.0, static_cast<double>(picture.width), static_cast<double>(picture.height)});
  return canvas;
}

Image Canvas::pixels() const {
  cairo_surface_t* surface = impl_->surface.get();
  if (cairo_surface_get_type(surface) != CAIRO_SURFACE_TYPE_IMAGE) return {};
  cairo_surface_flush(surface);
  Image picture(cairo_image_surface_get_width(surface), cairo_image_surface_get_height(surface));
  const unsigned char* data = cairo_image_surface_get_data(surface);
  const int stride = cairo_image_surface_get_stride(surface);
  for (int row = 0; row < picture.height; ++row) {
    const auto* line =
        reinterpret_cast<const std::uint32_t*>(data + static_cast<std::ptrdiff_t>(row) * stride);
    for (int column = 0; column < picture.width; ++column) {
      const std::uint32_t value = line[column];
      picture.set(column, row,
                  {static_cast<std::uint8_t>(value >> 16), static_cast<std::uint8_t>(value >> 8),
                   static_cast<std::uint8_t>(value)});
    }
  }
  return picture;
}

void Canvas::fill(const Rect& area, Color color) {
  cairo_t* cr = impl_->context.get();
  set_color(cr, color);
  cairo_rectangle(cr, area.x, area.y, area.width, area.height);
  cairo_fill(cr);
}

void Canvas::outline(const Rect& area, const Stroke& stroke) {
  cairo_t* cr = impl_->context.get();
  set_stroke(cr, stroke);
  cairo_rectangle(cr, area.x, area.y, area.width, area.height);
  cairo_stroke(cr);
}

void Canvas::fill(const std::vector<Eigen::Vector2d>& corners, Color color) {
  cairo_t* cr = impl_->context.get();
  set_color(cr, color);
  for (const Eigen::Vector2d& corner : corners) cairo_line_to(cr, corner.x(), corner.y());
  cairo_fill(cr);
}

void Canvas::line(const std::vector<Eigen::Vector2d>& points, const Stroke& stroke) {
  cairo_t* cr = impl_->context.get();
  set_stroke(cr, stroke);
  bool drawing = false;
  for (const Eigen::Vector2d& point : points) {
    const bool finite = point.allFinite();
    if (finite && drawing) cairo_line_to(cr, point.x(), point.y());
    if (finite && !drawing) cairo_move_to(cr, point.x(), point.y());
    drawing = finite;
  }
  cairo_stroke(cr);
}

void Canvas::squares(const std::vector<Eigen::Vector2d>& centers, double size, Color color) {
  cairo_t* cr = impl_->context.get();
  set_color(cr, color);
  for (const Eigen::Vector2d& center : centers) {
    cairo_rectangle(cr, center.x() - 0.5 * size, center.y() - 0.5 * size, size, size);
  }
  cairo_fill(cr);
}

void Canvas::disc(const Eigen::Vector2d& center, double radius, Color color) {
  cairo_t* cr = impl_->context.get();
  set_color(cr, color);
  cairo_arc(cr, center.x(), center.y(), radius, 0.0, 2.0 * std::numbers::pi);
  cairo_fill(cr);
}

double Canvas::text_width(const std::string& text, const TextStyle& style) {
  cairo_t* cr = impl_->context.get();
  set_font(cr, style);
  cairo_text_extents_t extents;
  cairo_text_extents(cr, name_text(text).c_str(), &extents);
  return extents.x_advance;
}

void Canvas::text(const Eigen::Vector2d& at, const std::string& text, const TextStyle& style) {
  cairo_t* cr = impl_->context.get();
  const double width = text_width(text, style);
  const double cap_height = 0.73 * style.size;
  cairo_save(cr);
  cairo_translate(cr, at.x(), at.y());
  if (style.upwards) cairo_rotate(cr, -std::numbers::pi / 2.0);
  set_color(cr, style.color);
  cairo_move_to(cr, -fraction_of(style.horizontal) * width,
                (1.0 - fraction_of(style.vertical)) * cap_height);
  cairo_show_text(cr, name_text(text).c_str());
  cairo_new_path(cr);
  cairo_restore(cr);
}

void Canvas::image(const Image& image, const Rect& area) {
  SurfacePtr pixels(cairo_image_surface_create(CAIRO_FORMAT_RGB24, image.width, image.height));
  if (cairo_surface_status(pixels.get()) != CAIRO_STATUS_SUCCESS || image.rgb.empty()) return;
  unsigned char* data = cairo_image_surface_get_data(pixels.get());
  const int stride = cairo_image_surface_get_stride(pixels.get());
  for (int row = 0; row < image.height; ++row) {
    auto* line = reinterpret_cast<std::uint32_t*>(data + static_cast<std::ptrdiff_t>(row) * stride);
    for (int column = 0; column < image.width; ++column) {
      const auto [red, green, blue] = image.pixel(column, row);
      line[column] = (std::uint32_t{red} << 16) | (std::uint32_t{green} << 8) | blue;
    }
  }
  cairo_surface_mark_dirty(pixels.get());
  cairo_t* cr = impl_->context.get();
  cairo_save(cr);
  cairo_translate(cr, area.x, area.y);
  cairo_scale(cr, area.width / image.width, area.height / image.height);
  cairo_set_source_surface(cr, pixels.get(), 0.0, 0.0);
  cairo_pattern_set_filter(cairo_get_source(cr), CAIRO_FILTER_NEAREST);
  cairo_rectangle(cr, 0.0, 0.0, image.width, image.height);
  cairo_fill(cr);
  cairo_restore(cr);
}

void Canvas::clip(const Rect& area) {
  cairo_t* cr = impl_->context.get();
  cairo_save(cr);
  cairo_rectangle(cr, area.x, area.y, area.width, area.height);
  cairo_clip(cr);
}

void Canvas::unclip() { cairo_restore(impl_->context.get()); }

Result<void> Canvas::finish() {
  const std::string name = impl_->path.string();
  cairo_status_t status = cairo_status(impl_->context.get());
  impl_->context.reset();
  if (status == CAIRO_STATUS_SUCCESS && impl_->path.extension() == ".png") {
    status = cairo_surface_write_to_png(impl_->surface.get(), impl_->partial.c_str());
  }
  cairo_surface_finish(impl_->surface.get());
  if (status == CAIRO_STATUS_SUCCESS) status = cairo_surface_status(impl_->surface.get());
  if (status != CAIRO_STATUS_SUCCESS) return failure(name + ": cannot write: " + reason(status));
  std::error_code error;
  std::filesystem::rename(impl_->partial, impl_->path, error);
  if (error) return failure(name + ": cannot write: " + error.message());
  return {};
}

}  // namespace aims
