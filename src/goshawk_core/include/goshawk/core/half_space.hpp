#pragma once

#include <cmath>

#include "goshawk/core/vector.hpp"

namespace goshawk {

/// {p : normal . p <= offset_m}, frame `map`: one face of a polytope.
struct HalfSpace {
  Vec3 normal = Vec3::UnitX();  // outward, of unit length
  double offset_m = 0.0;

  /// @return [m] from the plane to the point: negative inside, NaN if anything is NaN
  double distance_m(const Vec3& p_map) const {
    return normal[0] * p_map[0] + normal[1] * p_map[1] + normal[2] * p_map[2] - offset_m;
  }

  bool is_finite() const { return normal.allFinite() && std::isfinite(offset_m); }
  friend bool operator==(const HalfSpace&, const HalfSpace&) = default;
};
// Half-spaces in a row are a matrix of four columns (Polytope::A, Polytope::b).
static_assert(sizeof(HalfSpace) == 4 * sizeof(double));

}  // namespace goshawk
