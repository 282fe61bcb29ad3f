#include "plot.hpp"

#include <cairo.h>
#include <fmt/format.h>

#include <cmath>

#include "file.hpp"

namespace goshawk::flight_report {

namespace {

constexpr Stroke kGrid{{0.0, 0.0, 0.0, 0.09}};
constexpr Stroke kFrame{{0.45, 0.47, 0.5}, 1.2};
constexpr double kTickGap_px = 60.0;  // at least, between two numbers; upwards less
constexpr double kSign_px = 32.0;     // width of a sign in the legend

void set(cairo_t* c, const Color& color) {
  cairo_set_source_rgba(c, color.r, color.g, color.b, color.a);
}

cairo_status_t append(void* bytes, const unsigned char* data, unsigned length) {
  static_cast<std::string*>(bytes)->append(reinterpret_cast<const char*>(data), length);
  return CAIRO_STATUS_SUCCESS;
}

std::vector<Vec2> rectangle(const Vec2& corner, const Vec2& size) {
  return {corner, corner + Vec2(size.x(), 0.0), corner + size, corner + Vec2(0.0, size.y()),
          corner};
}

/// 1, 2 or 5 times a power of ten, at least `least`.
double round_step(double least) {
  const double power = std::pow(10.0, std::floor(std::log10(least)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * power >= least * (1.0 - 1e-9)) return factor * power;
  }
  return 10.0 * power;
}

/// Calls tick(value, number) for the multiples of a round step within the interval.
void for_ticks(const Interval& interval, double least_step,
               const std::function<void(double, const std::string&)>& tick) {
  const double step = round_step(least_step);
  const int digits = std::max(0, int(std::ceil(-std::log10(step) - 1e-9)));
  const double first = std::ceil(interval.lo / step - 1e-9);
  const int count = std::min(400, int(std::floor(interval.hi / step + 1e-9) - first) + 1);
  for (int k = 0; k < count; ++k) {
    const double value = (first + k) * step;
    // No "-0": it comes from the rounding of a tick next to zero.
    const double shown = std::abs(value) < step / 2.0 ? 0.0 : value;
    tick(value, fmt::format("{:.{}f}", shown, digits));
  }
}

}  // namespace

Sheet::Sheet(int width_px, int height_px) : context_(nullptr, cairo_destroy) {
  cairo_surface_t* surface = cairo_image_surface_create(CAIRO_FORMAT_RGB24, width_px, height_px);
  context_.reset(cairo_create(surface));
  cairo_surface_destroy(surface);  // the context keeps it
  set(context(), kWhite);
  cairo_paint(context());
  cairo_set_line_join(context(), CAIRO_LINE_JOIN_ROUND);
}

void Sheet::paint(const Stroke& stroke, const Color& fill) {
  cairo_t* c = context();
  set(c, fill);
  cairo_fill_preserve(c);
  set(c, stroke.color);
  cairo_set_line_width(c, stroke.width_px);
  cairo_set_dash(c, &stroke.dash_px, stroke.dash_px > 0.0 ? 1 : 0, 0.0);
  cairo_stroke(c);
}

void Sheet::line(const std::vector<Vec2>& points, const Stroke& stroke, const Color& fill) {
  cairo_new_path(context());
  for (const Vec2& p : points) cairo_line_to(context(), p.x(), p.y());
  if (fill.a > 0.0) cairo_close_path(context());
  paint(stroke, fill);
}

void Sheet::dot(const Vec2& center, double radius_px, const Color& fill, const Stroke& edge) {
  cairo_new_path(context());
  cairo_arc(context(), center.x(), center.y(), radius_px, 0.0, 2.0 * M_PI);
  cairo_close_path(context());
  paint(edge, fill);
}

void Sheet::text(const Vec2& at, const std::string& words, const TextStyle& style) {
  cairo_t* c = context();
  cairo_save(c);
  // If this family is missing, Cairo takes another, down to one that it carries itself.
  cairo_select_font_face(c, "DejaVu Sans", CAIRO_FONT_SLANT_NORMAL,
                         style.bold ? CAIRO_FONT_WEIGHT_BOLD : CAIRO_FONT_WEIGHT_NORMAL);
  cairo_set_font_size(c, style.size_px);
  cairo_text_extents_t extents;
  cairo_text_extents(c, words.c_str(), &extents);
  cairo_translate(c, at.x(), at.y());
  if (style.upwards) cairo_rotate(c, -M_PI / 2.0);
  set(c, style.color);
  // 0.36: half of a capital's height.
  cairo_move_to(c, -style.align * extents.x_advance, 0.36 * style.size_px);
  cairo_show_text(c, words.c_str());
  cairo_restore(c);
}

Status Sheet::save(const std::filesystem::path& png) const {
  std::string bytes;
  cairo_status_t status = cairo_status(context());
  if (status == CAIRO_STATUS_SUCCESS) {
    status = cairo_surface_write_to_png_stream(cairo_get_target(context()), append, &bytes);
  }
  if (status == CAIRO_STATUS_SUCCESS) return write_file(png, bytes);
  return fail(ErrorCode::io_failed, fmt::format("Cairo could not draw '{}': {}", png.string(),
                                                cairo_status_to_string(status)));
}

Plot::Plot(Sheet& sheet, const Vec2& corner_px, const Vec2& size_px, const Interval& u,
           const Interval& v)
    : sheet_(sheet),
      corner_(corner_px),
      size_(size_px),
      u_(u),
      v_(v),
      entry_px_(corner_px + Vec2(size_px.x() + 20.0, 10.0)) {}

Vec2 Plot::pixel(const Vec2& at) const {
  const Vec2 share((at.x() - u_.lo) / u_.length(), (v_.hi - at.y()) / v_.length());
  return corner_ + share.cwiseProduct(size_);
}

void Plot::axes(const std::string& u_label, const std::string& v_label) {
  const Vec2 end = corner_ + size_;
  for_ticks(u_, u_.length() / size_.x() * kTickGap_px, [&](double u, const std::string& number) {
    const double x = pixel({u, v_.lo}).x();
    sheet_.line({{x, corner_.y()}, {x, end.y()}}, kGrid);
    if (!u_label.empty()) sheet_.text({x, end.y() + 13.0}, number, {.align = 0.5});
  });
  for_ticks(v_, v_.length() / size_.y() * kTickGap_px * 0.6, [&](double v, const auto& number) {
    const double y = pixel({u_.lo, v}).y();
    sheet_.line({{corner_.x(), y}, {end.x(), y}}, kGrid);
    sheet_.text({corner_.x() - 8.0, y}, number, {.align = 1.0});
  });
  sheet_.line(rectangle(corner_, size_), kFrame);
  sheet_.text({corner_.x() + size_.x() / 2.0, end.y() + 35.0}, u_label,
              {.size_px = 14.0, .align = 0.5});
  sheet_.text({corner_.x() - 54.0, corner_.y() + size_.y() / 2.0}, v_label,
              {.size_px = 14.0, .align = 0.5, .upwards = true});
}

void Plot::clipped(const std::function<void()>& draw) {
  cairo_t* c = sheet_.context();
  cairo_save(c);
  cairo_rectangle(c, corner_.x(), corner_.y(), size_.x(), size_.y());
  cairo_clip(c);
  draw();
  cairo_restore(c);
}

void Plot::line(std::vector<Vec2> points, const Stroke& stroke, const Color& fill) {
  for (Vec2& p : points) p = pixel(p);
  clipped([&] { sheet_.line(points, stroke, fill); });
}

void Plot::dot(const Vec2& at, double radius_px, const Color& fill, const Stroke& edge) {
  clipped([&] { sheet_.dot(pixel(at), radius_px, fill, edge); });
}

void Plot::image(const Interval& u, const Interval& v, const Image& image) {
  if (image.pixels.empty()) return;
  const int height = int(image.pixels.size()) / image.width;
  auto pixels = image.pixels;  // Cairo asks for memory that it may write to
  cairo_surface_t* surface =
      cairo_image_surface_create_for_data(reinterpret_cast<unsigned char*>(pixels.data()),
                                          CAIRO_FORMAT_RGB24, image.width, height, 4 * image.width);
  const Vec2 corner = pixel({u.lo, v.hi}), size = pixel({u.hi, v.lo}) - corner;
  const bool shrinks = size.x() < image.width || size.y() < height;
  clipped([&] {
    cairo_t* c = sheet_.context();
    cairo_translate(c, corner.x(), corner.y());
    cairo_scale(c, size.x() / image.width, size.y() / height);
    cairo_set_source_surface(c, surface, 0.0, 0.0);
    const auto filter = shrinks ? CAIRO_FILTER_GOOD : CAIRO_FILTER_NEAREST;
    cairo_pattern_set_filter(cairo_get_source(c), filter);
    cairo_paint(c);
  });
  cairo_surface_destroy(surface);
}

void Plot::note(const std::string& words, double indent_px) {
  sheet_.text(entry_px_ + Vec2(indent_px, 0.0), words);
  leave_gap(23.0);
}

void Plot::explain_line(const std::string& words, const Stroke& stroke, double dot_px) {
  const Vec2 at = entry_px_;
  sheet_.line({at, at + Vec2(kSign_px, 0.0)}, stroke);
  if (dot_px > 0.0) sheet_.dot(at + Vec2(kSign_px / 2.0, 0.0), dot_px, kWhite, stroke);
  note(words, kSign_px + 10.0);
}

void Plot::explain_box(const std::string& words, const Color& fill, const Color& edge) {
  sheet_.line(rectangle(entry_px_ - Vec2(0.0, 7.0), {kSign_px, 14.0}), {edge}, fill);
  note(words, kSign_px + 10.0);
}

void Plot::explain_scale(const std::string& words, double largest,
                         const std::function<Color(double)>& color_of_share) {
  constexpr int kWidth_px = 190;
  note(words);
  for (int k = 0; k < kWidth_px; ++k) {
    const Vec2 at = entry_px_ + Vec2(k + 0.5, -9.0);
    sheet_.line({at, at + Vec2(0.0, 12.0)}, {color_of_share((k + 0.5) / kWidth_px), 1.6});
  }
  for (int k = 0; k <= 4; ++k) {
    sheet_.text(entry_px_ + Vec2(kWidth_px * k / 4.0, 15.0),
                fmt::format("{:.2f}", largest * k / 4.0), {.size_px = 12.0, .align = 0.5});
  }
}

}  // namespace goshawk::flight_report
