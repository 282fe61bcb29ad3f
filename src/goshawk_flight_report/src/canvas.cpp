#include "canvas.hpp"

#include <cairo.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "file.hpp"
#include "goshawk/visualization/speed_color.hpp"

namespace goshawk::flight_report {

namespace {

void set(cairo_t* c, const Color& color) {
  cairo_set_source_rgba(c, color.r, color.g, color.b, color.a);
}

cairo_status_t append(void* bytes, const unsigned char* data, unsigned length) {
  static_cast<std::string*>(bytes)->append(reinterpret_cast<const char*>(data), length);
  return CAIRO_STATUS_SUCCESS;
}

}  // namespace

std::uint32_t packed(const Color& c) {
  const auto byte = [](double x) {
    return std::uint32_t(std::lround(255.0 * std::clamp(x, 0.0, 1.0)));
  };
  return byte(c.a) << 24 | byte(c.r * c.a) << 16 | byte(c.g * c.a) << 8 | byte(c.b * c.a);
}

void Canvas::Destroy::operator()(cairo_t* context) const {
  cairo_destroy(context);
}

Canvas::Canvas(int width_px, int height_px) {
  cairo_surface_t* surface = cairo_image_surface_create(CAIRO_FORMAT_RGB24, width_px, height_px);
  context_.reset(cairo_create(surface));
  cairo_surface_destroy(surface);  // the context keeps it
  cairo_t* c = context_.get();
  cairo_set_source_rgb(c, 1.0, 1.0, 1.0);
  cairo_paint(c);
  cairo_set_line_join(c, CAIRO_LINE_JOIN_ROUND);
  cairo_set_line_cap(c, CAIRO_LINE_CAP_BUTT);
}

Canvas::~Canvas() = default;

void Canvas::trace(std::span<const Vec2> points) {
  cairo_new_path(context_.get());
  for (const Vec2& p : points) cairo_line_to(context_.get(), p.x(), p.y());
}

void Canvas::stroke(const Stroke& stroke) {
  cairo_t* c = context_.get();
  set(c, stroke.color);
  cairo_set_line_width(c, stroke.width_px);
  const double dashes[] = {stroke.dash_px, stroke.dash_px};
  cairo_set_dash(c, dashes, stroke.dash_px > 0.0 ? 2 : 0, 0.0);
  cairo_stroke(c);
}

void Canvas::polyline(std::span<const Vec2> points, const Stroke& line) {
  if (points.size() < 2) return;
  trace(points);
  stroke(line);
}

void Canvas::polygon(std::span<const Vec2> points, const Color& fill, const Stroke& edge) {
  if (points.size() < 3) return;
  trace(points);
  cairo_close_path(context_.get());
  set(context_.get(), fill);
  cairo_fill_preserve(context_.get());
  stroke(edge);
}

void Canvas::rectangle(const Rectangle& r, const Color& fill, const Stroke& edge) {
  const std::array<Vec2, 4> corners{Vec2(r.left, r.top), Vec2(r.left + r.width, r.top),
                                    Vec2(r.left + r.width, r.top + r.height),
                                    Vec2(r.left, r.top + r.height)};
  polygon(corners, fill, edge);
}

void Canvas::dot(const Vec2& center, double radius_px, const Color& fill, const Stroke& edge) {
  cairo_new_path(context_.get());
  cairo_arc(context_.get(), center.x(), center.y(), radius_px, 0.0, 2.0 * M_PI);
  cairo_close_path(context_.get());
  set(context_.get(), fill);
  cairo_fill_preserve(context_.get());
  stroke(edge);
}

void Canvas::text(const Vec2& at, const std::string& words, const TextStyle& style) {
  cairo_t* c = context_.get();
  cairo_save(c);
  // Where this family is missing, Cairo takes another, down to one that it carries itself.
  cairo_select_font_face(c, "DejaVu Sans", CAIRO_FONT_SLANT_NORMAL,
                         style.bold ? CAIRO_FONT_WEIGHT_BOLD : CAIRO_FONT_WEIGHT_NORMAL);
  cairo_set_font_size(c, style.size_px);
  cairo_text_extents_t extents;
  cairo_text_extents(c, words.c_str(), &extents);
  cairo_translate(c, at.x(), at.y());
  if (style.upwards) cairo_rotate(c, -M_PI / 2.0);
  const double along = style.align == Align::left     ? 0.0
                       : style.align == Align::center ? extents.x_advance / 2.0
                                                      : extents.x_advance;
  set(c, style.color);
  cairo_move_to(c, -along, 0.36 * style.size_px);  // half of a capital's height
  cairo_show_text(c, words.c_str());
  cairo_restore(c);
}

void Canvas::image(const Rectangle& place, const Image& image) {
  if (image.width < 1 || image.height < 1) return;
  cairo_t* c = context_.get();
  cairo_surface_t* surface =
      cairo_image_surface_create(CAIRO_FORMAT_ARGB32, image.width, image.height);
  if (cairo_surface_status(surface) != CAIRO_STATUS_SUCCESS) {
    cairo_surface_destroy(surface);
    return;
  }
  unsigned char* rows = cairo_image_surface_get_data(surface);
  const int stride = cairo_image_surface_get_stride(surface);
  for (int y = 0; y < image.height; ++y) {
    std::copy_n(image.pixels.data() + std::size_t(y) * std::size_t(image.width), image.width,
                reinterpret_cast<std::uint32_t*>(rows + std::ptrdiff_t(y) * stride));
  }
  cairo_surface_mark_dirty(surface);
  cairo_save(c);
  cairo_translate(c, place.left, place.top);
  cairo_scale(c, place.width / image.width, place.height / image.height);
  cairo_set_source_surface(c, surface, 0.0, 0.0);
  const bool shrinks = place.width < image.width || place.height < image.height;
  cairo_pattern_set_filter(cairo_get_source(c), shrinks ? CAIRO_FILTER_GOOD : CAIRO_FILTER_NEAREST);
  cairo_paint(c);
  cairo_restore(c);
  cairo_surface_destroy(surface);
}

void Canvas::clip(const Rectangle& r) {
  cairo_save(context_.get());
  cairo_rectangle(context_.get(), r.left, r.top, r.width, r.height);
  cairo_clip(context_.get());
}

void Canvas::unclip() {
  cairo_restore(context_.get());
}

Status Canvas::save(const std::filesystem::path& png) const {
  std::string bytes;
  cairo_t* c = context_.get();
  cairo_status_t status = cairo_status(c);
  if (status == CAIRO_STATUS_SUCCESS) {
    status = cairo_surface_write_to_png_stream(cairo_get_target(c), append, &bytes);
  }
  if (status == CAIRO_STATUS_SUCCESS) return write_file(png, bytes);
  return fail(ErrorCode::io_failed,
              "Cairo could not draw '" + png.string() + "': " + cairo_status_to_string(status));
}

Color speed_color(double ratio) {
  const Vec3 c = visualization::speed_color(ratio);
  return {c.x(), c.y(), c.z()};
}

}  // namespace goshawk::flight_report
