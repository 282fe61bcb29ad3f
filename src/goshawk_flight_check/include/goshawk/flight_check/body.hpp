#pragma once

#include "goshawk/core/result.hpp"

namespace goshawk::flight_check {

/// The vehicle as a solid, its middle in the origin of `base_link`, its axis along that frame's z.
/// A cylinder unless `is_box`: then length (x) by width (y) by height (z).
struct Body {
  double radius_m = 0.15;  // [m] of the cylinder: propellers included
  double height_m = 0.1;   // [m] of the cylinder or the box
  bool is_box = false;
  double length_m = 0.3;  // [m] of the box along x
  double width_m = 0.3;   // [m] of the box along y

  /// @return invalid_parameter, naming every edge in use that lies outside of (0, 100] m
  Status check() const;

  /// @return [m] how far the body's farthest point is from base_link: turning by an angle moves
  /// no point farther than reach times that angle
  double reach_m() const;
};

}  // namespace goshawk::flight_check
