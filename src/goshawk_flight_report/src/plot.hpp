#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "goshawk/core/result.hpp"

typedef struct _cairo cairo_t;  // as in cairo.h, which stays out of headers

namespace goshawk::flight_report {

using Vec2 = Eigen::Vector2d;

struct Color {
  double r = 0.0, g = 0.0, b = 0.0, a = 1.0;
};
inline constexpr Color kWhite{1.0, 1.0, 1.0};
inline constexpr Color kClear{0.0, 0.0, 0.0, 0.0};

struct Stroke {
  Color color;
  double width_px = 1.0;
  double dash_px = 0.0;  // 0: solid
};

struct TextStyle {
  double size_px = 13.0;
  double align = 0.0;  // 0: begins there, 0.5: is centred there, 1: ends there
  Color color{0.25, 0.27, 0.3};
  bool bold = false;
  bool upwards = false;  // turned by a quarter, reading from the bottom up
};

/// 0xRRGGBB, row by row from the top.
struct Image {
  int width = 0;
  std::vector<std::uint32_t> pixels;
};

struct Interval {
  double lo = 0.0;
  double hi = 1.0;
  double length() const { return hi - lo; }
  void include(double x) {
    lo = std::min(lo, x);
    hi = std::max(hi, x);
  }
};

/// A white sheet, in pixels from the upper left corner. Cairo underneath.
class Sheet {
 public:
  Sheet(int width_px, int height_px);
  /// @param at the middle of the text's height
  void text(const Vec2& at, const std::string& words, const TextStyle& style = {});
  /// A line through the points, or, with a fill, a polygon.
  void line(const std::vector<Vec2>& points, const Stroke& stroke, const Color& fill = kClear);
  void dot(const Vec2& center, double radius_px, const Color& fill, const Stroke& edge);
  cairo_t* context() const { return context_.get(); }
  Status save(const std::filesystem::path& png) const;

 private:
  void paint(const Stroke& stroke, const Color& fill);
  std::unique_ptr<cairo_t, void (*)(cairo_t*)> context_;
};

/// A rectangle of the sheet with a horizontal axis u to the right and a vertical axis v upwards,
/// and a legend at its right. What is drawn is given in u and v, and cut off at the rectangle.
class Plot {
 public:
  /// @param corner_px, size_px of the rectangle
  Plot(Sheet& sheet, const Vec2& corner_px, const Vec2& size_px, const Interval& u,
       const Interval& v);

  const Interval& u() const { return u_; }
  const Interval& v() const { return v_; }
  Vec2 pixel(const Vec2& at) const;

  /// Grid lines with numbers along the left and the lower side, and the frame.
  /// @param u_label empty: no numbers at the lower side either
  void axes(const std::string& u_label, const std::string& v_label);
  void line(std::vector<Vec2> points, const Stroke& stroke, const Color& fill = kClear);
  void dot(const Vec2& at, double radius_px, const Color& fill, const Stroke& edge);
  /// Pixels of the image keep sharp edges; if they are smaller than the sheet's, they are averaged.
  void image(const Interval& u, const Interval& v, const Image& image);

  /// Entries of the legend, one below the other.
  void explain_line(const std::string& words, const Stroke& stroke, double dot_px = 0.0);
  void explain_box(const std::string& words, const Color& fill, const Color& edge);
  void explain_scale(const std::string& words, double largest,
                     const std::function<Color(double)>& color_of_share);
  void note(const std::string& words, double indent_px = 0.0);
  void leave_gap(double height_px) { entry_px_.y() += height_px; }

 private:
  void clipped(const std::function<void()>& draw);

  Sheet& sheet_;
  Vec2 corner_;  // upper left [pixel]
  Vec2 size_;
  Interval u_;
  Interval v_;
  Vec2 entry_px_;  // of the legend, the next one
};

}  // namespace goshawk::flight_report
