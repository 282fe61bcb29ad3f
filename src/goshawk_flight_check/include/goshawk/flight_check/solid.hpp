#pragma once

#include "goshawk/core/result.hpp"
#include "goshawk/core/vector.hpp"

namespace goshawk::flight_check {

/// An obstacle of a world that is known exactly: an upright cylinder, or a box along the axes.
struct Solid {
  bool is_box = false;
  Vec3 center_map = Vec3::Zero();  // [m]
  Vec3 size_m = Vec3::Ones();      // box: its edges; cylinder: diameter, diameter, height

  /// @return invalid_input if a number is not finite, an edge is not above zero, or a cylinder's
  /// two diameters differ
  Status check() const;
};

}  // namespace goshawk::flight_check
