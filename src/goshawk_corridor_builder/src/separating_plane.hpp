#pragma once

#include "goshawk/core/vector.hpp"

namespace goshawk::corridor_builder {

/// n . x <= d is the free side. Coordinates in voxel edges.
struct Plane {
  Vec3 normal = Vec3::UnitX();  // unit length to rounding
  double offset = 0.0;
  bool tight = false;  // the path comes so near that only rounding is between plane and obstacle

  double slack(const Vec3& p) const { return offset - normal.dot(p); }
};

/// How far planes keep from obstacles, in voxel edges, so that no rounding lets one cut in.
struct Margins {
  double plane = 1e-7;      // an ordinary plane's distance from its obstacle
  double rounding = 1e-12;  // bound on the error of all arithmetic with coordinates of this map
  double touch = 1e-9;      // a path may enter an obstacle by so much: it only touches it

  /// Behind a plane is what every point of has n . x >= this.
  double behind(const Plane& p) const { return p.offset + (p.tight ? rounding : 0.5 * plane); }

  /// @param largest_coordinate [voxel edges] of the map, its origin included
  static Margins for_coordinates(double largest_coordinate);
};

struct Segment {
  Vec3 p;
  Vec3 q;
};

/// The least n . x over a box.
inline double support(const Vec3& n, const Vec3& lower, const Vec3& upper) {
  return n[0] * (n[0] > 0 ? lower[0] : upper[0]) + n[1] * (n[1] > 0 ? lower[1] : upper[1]) +
         n[2] * (n[2] > 0 ? lower[2] : upper[2]);
}

/// A plane with the whole box beyond it and the whole segment before it.
///
/// The normal starts as `wanted` (where the ellipsoid touches the box) and turns towards the
/// direction of least distance between segment and box, only as far as needed for both ends to
/// keep `wanted_slack` (less where the box itself is nearer than that).
/// @return false where segment and box cannot be separated: the segment enters the box
bool separate(const Vec3& wanted, const Vec3& lower, const Vec3& upper, const Segment& segment,
              double wanted_slack, const Margins& margins, Plane& plane);

/// Where between p (0) and q (1) the segment is nearest to a box; the middle of what is inside.
double nearest_parameter(const Segment& segment, const Vec3& lower, const Vec3& upper);

}  // namespace goshawk::corridor_builder
