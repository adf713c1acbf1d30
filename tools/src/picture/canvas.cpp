#include "canvas.h"

#include <cairo.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numbers>

#include "palpate/core/error.h"

namespace palpate::tools {
namespace {

constexpr const char* kFont = "DejaVu Sans";

struct Destroy {
  void operator()(cairo_surface_t* surface) const { cairo_surface_destroy(surface); }
  void operator()(cairo_t* context) const { cairo_destroy(context); }
};
using Surface = std::unique_ptr<cairo_surface_t, Destroy>;

}  // namespace

struct Canvas::Impl {
  Surface surface;
  std::unique_ptr<cairo_t, Destroy> context;

  [[nodiscard]] cairo_t* cr() const { return context.get(); }
  void ink(const Color& c) const { cairo_set_source_rgba(cr(), c.r, c.g, c.b, c.a); }
  void pen(const Stroke& stroke) const {
    ink(stroke.color);
    cairo_set_line_width(cr(), stroke.width);
    cairo_set_line_join(cr(), CAIRO_LINE_JOIN_ROUND);
    cairo_set_line_cap(cr(), stroke.dash.empty() ? CAIRO_LINE_CAP_ROUND : CAIRO_LINE_CAP_BUTT);
    cairo_set_dash(cr(), stroke.dash.data(), static_cast<int>(stroke.dash.size()), 0.0);
  }
  void path(const std::vector<Pixel>& points, bool closed) const {
    cairo_new_path(cr());
    for (const Pixel& p : points) cairo_line_to(cr(), p.x, p.y);
    if (closed) cairo_close_path(cr());
  }
  void font(const TextStyle& style) const {
    cairo_select_font_face(cr(), kFont,
                           style.italic ? CAIRO_FONT_SLANT_OBLIQUE : CAIRO_FONT_SLANT_NORMAL,
                           style.bold ? CAIRO_FONT_WEIGHT_BOLD : CAIRO_FONT_WEIGHT_NORMAL);
    cairo_set_font_size(cr(), style.size);
  }
};

Canvas::Canvas(int width, int height) : impl_(std::make_unique<Impl>()) {
  impl_->surface.reset(cairo_image_surface_create(CAIRO_FORMAT_RGB24, width, height));
  impl_->context.reset(cairo_create(impl_->surface.get()));
}

Canvas::~Canvas() = default;

void Canvas::fill(const Color& color) {
  impl_->ink(color);
  cairo_paint(impl_->cr());
}

void Canvas::image(const Raster& raster, double x, double y) {
  const Surface surface(
      cairo_image_surface_create(CAIRO_FORMAT_RGB24, raster.width, raster.height));
  cairo_surface_flush(surface.get());
  unsigned char* data = cairo_image_surface_get_data(surface.get());
  if (data == nullptr) return;
  const auto stride = static_cast<std::size_t>(cairo_image_surface_get_stride(surface.get()));
  const auto width = static_cast<std::size_t>(raster.width);
  for (std::size_t row = 0; row < static_cast<std::size_t>(raster.height); ++row) {
    std::memcpy(data + row * stride, raster.words.data() + row * width, width * 4);
  }
  cairo_surface_mark_dirty(surface.get());
  cairo_set_source_surface(impl_->cr(), surface.get(), x, y);
  cairo_paint(impl_->cr());
}

void Canvas::rectangle(double x, double y, double w, double h, const Color& color, double radius) {
  impl_->ink(color);
  cairo_new_path(impl_->cr());
  if (radius <= 0.0) {
    cairo_rectangle(impl_->cr(), x, y, w, h);
  } else {
    constexpr double kQuarter = std::numbers::pi / 2.0;
    cairo_arc(impl_->cr(), x + w - radius, y + radius, radius, -kQuarter, 0.0);
    cairo_arc(impl_->cr(), x + w - radius, y + h - radius, radius, 0.0, kQuarter);
    cairo_arc(impl_->cr(), x + radius, y + h - radius, radius, kQuarter, 2.0 * kQuarter);
    cairo_arc(impl_->cr(), x + radius, y + radius, radius, 2.0 * kQuarter, 3.0 * kQuarter);
    cairo_close_path(impl_->cr());
  }
  cairo_fill(impl_->cr());
}

void Canvas::frame(double x, double y, double w, double h, const Stroke& stroke) {
  line({{x, y}, {x + w, y}, {x + w, y + h}, {x, y + h}}, stroke, true);
}

void Canvas::line(const std::vector<Pixel>& points, const Stroke& stroke, bool closed) {
  if (points.size() < 2) return;
  impl_->path(points, closed);
  impl_->pen(stroke);
  cairo_stroke(impl_->cr());
}

void Canvas::polygon(const std::vector<Pixel>& points, const Color& color) {
  impl_->path(points, true);
  impl_->ink(color);
  cairo_fill(impl_->cr());
}

void Canvas::disk(const Pixel& center, double radius, const Color& color) {
  cairo_new_path(impl_->cr());
  cairo_arc(impl_->cr(), center.x, center.y, radius, 0.0, 2.0 * std::numbers::pi);
  impl_->ink(color);
  cairo_fill(impl_->cr());
}

void Canvas::arrow(const Pixel& from, const Pixel& to, const Stroke& stroke, double head) {
  const double dx = to.x - from.x;
  const double dy = to.y - from.y;
  const double length = std::hypot(dx, dy);
  if (!(length > 0.0)) return;
  const double h = std::min(head, length);
  const Pixel along{dx / length, dy / length};
  const Pixel neck{to.x - along.x * h, to.y - along.y * h};
  const double side = 0.42 * h;
  line({from, neck}, stroke);
  polygon({to,
           {neck.x - along.y * side, neck.y + along.x * side},
           {neck.x + along.y * side, neck.y - along.x * side}},
          stroke.color);
}

void Canvas::text(const Pixel& at, const std::string& text, const TextStyle& style) {
  cairo_t* cr = impl_->cr();
  const double width = textWidth(text, style);
  const double shift = style.align == Align::kLeft     ? 0.0
                       : style.align == Align::kCenter ? -0.5 * width
                                                       : -width;
  cairo_save(cr);
  cairo_translate(cr, at.x, at.y);
  if (style.upright) cairo_rotate(cr, -std::numbers::pi / 2.0);
  cairo_new_path(cr);
  cairo_move_to(cr, shift, 0.0);
  cairo_text_path(cr, text.c_str());
  if (style.halo > 0.0) {
    impl_->pen({{1.0, 1.0, 1.0, 0.8}, 2.0 * style.halo});
    cairo_stroke_preserve(cr);
  }
  impl_->ink(style.color);
  cairo_fill(cr);
  cairo_restore(cr);
}

double Canvas::textWidth(const std::string& text, const TextStyle& style) {
  impl_->font(style);
  cairo_text_extents_t extents;
  cairo_text_extents(impl_->cr(), text.c_str(), &extents);
  return extents.x_advance;
}

void Canvas::clip(double x, double y, double w, double h) {
  cairo_save(impl_->cr());
  cairo_new_path(impl_->cr());
  cairo_rectangle(impl_->cr(), x, y, w, h);
  cairo_clip(impl_->cr());
}

void Canvas::unclip() { cairo_restore(impl_->cr()); }

Canvas::Bytes Canvas::bytes() const {
  cairo_surface_t* const surface = impl_->surface.get();
  cairo_surface_flush(surface);
  return {cairo_image_surface_get_data(surface), cairo_image_surface_get_width(surface),
          cairo_image_surface_get_height(surface), cairo_image_surface_get_stride(surface)};
}

std::string Canvas::png() const {
  std::string bytes;
  const auto take = [](void* to, const unsigned char* data, unsigned length) {
    static_cast<std::string*>(to)->append(reinterpret_cast<const char*>(data), length);
    return CAIRO_STATUS_SUCCESS;
  };
  const cairo_status_t status =
      cairo_surface_write_to_png_stream(impl_->surface.get(), take, &bytes);
  if (status != CAIRO_STATUS_SUCCESS) {
    throw Error(
        ErrorKind::kOperation,
        {"picture.png", std::string("cannot make the picture: ") + cairo_status_to_string(status),
         "try a smaller picture"});
  }
  return bytes;
}

}  // namespace palpate::tools
