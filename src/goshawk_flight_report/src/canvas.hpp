#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "goshawk/core/result.hpp"

typedef struct _cairo cairo_t;  // as in cairo.h, which stays out of headers

namespace goshawk::flight_report {

using Vec2 = Eigen::Vector2d;

struct Color {
  double r = 0.0, g = 0.0, b = 0.0, a = 1.0;
};

/// 0xAARRGGBB, premultiplied, row by row from the top.
struct Image {
  int width = 0;
  int height = 0;
  std::vector<std::uint32_t> pixels;
};
std::uint32_t packed(const Color& c);

struct Rectangle {
  double left = 0.0, top = 0.0, width = 0.0, height = 0.0;
};

enum class Align { left, center, right };

struct TextStyle {
  double size_px = 13.0;
  Align align = Align::left;
  Color color{0.25, 0.27, 0.3};
  bool bold = false;
  bool upwards = false;  // turned by a quarter, reading from the bottom up
};

struct Stroke {
  Color color;
  double width_px = 1.0;
  double dash_px = 0.0;  // 0: solid
};

/// A white sheet, in pixels from the upper left corner. Cairo underneath.
class Canvas {
 public:
  Canvas(int width_px, int height_px);
  ~Canvas();
  Canvas(const Canvas&) = delete;
  Canvas& operator=(const Canvas&) = delete;

  void polyline(std::span<const Vec2> points, const Stroke& stroke);
  void polygon(std::span<const Vec2> points, const Color& fill, const Stroke& edge);
  void rectangle(const Rectangle& r, const Color& fill, const Stroke& edge);
  void dot(const Vec2& center, double radius_px, const Color& fill, const Stroke& edge);
  /// @param at the middle of the text's height, and its left end, middle or right end
  void text(const Vec2& at, const std::string& words, const TextStyle& style);
  /// Voxels keep sharp edges; where there are more of them than pixels, they are averaged.
  void image(const Rectangle& place, const Image& image);

  /// Nothing is drawn outside of r until unclip().
  void clip(const Rectangle& r);
  void unclip();

  Status save(const std::filesystem::path& png) const;

 private:
  void trace(std::span<const Vec2> points);
  void stroke(const Stroke& stroke);
  struct Destroy {
    void operator()(cairo_t* context) const;
  };
  std::unique_ptr<cairo_t, Destroy> context_;
};

Color speed_color(double ratio);  // visualization::speed_color()

}  // namespace goshawk::flight_report
