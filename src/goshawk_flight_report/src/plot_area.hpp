#pragma once

#include <algorithm>
#include <string>

#include "canvas.hpp"

namespace goshawk::flight_report {

struct Interval {
  double lo = 0.0;
  double hi = 1.0;
  double length() const { return hi - lo; }
  void include(double x) {
    lo = std::min(lo, x);
    hi = std::max(hi, x);
  }
};

/// A rectangle of the sheet with a horizontal axis u to the right and a vertical axis v upwards.
struct PlotArea {
  Rectangle place;
  Interval u;
  Interval v;

  Vec2 pixel(double at_u, double at_v) const {
    return {place.left + (at_u - u.lo) / u.length() * place.width,
            place.top + (v.hi - at_v) / v.length() * place.height};
  }
};

/// Draws grid lines, numbers and labels along the left and the lower side.
struct Axes {
  std::string u_label;
  std::string v_label;
  bool u_numbers = true;
  double fewest_px = 60.0;  // between two numbers
};
void draw_axes(Canvas& canvas, const PlotArea& area, const Axes& axes);

/// @return 1, 2 or 5 times a power of ten, at least `least`. @pre least > 0 and finite
double round_step(double least);

}  // namespace goshawk::flight_report
