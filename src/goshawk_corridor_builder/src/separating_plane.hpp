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

/// Radii of balls around both ends of a segment [voxel edges].
struct Room {
  double p = 0.0;
  double q = 0.0;
};

/// What a plane must leave in front: the hull of two balls around the ends of a segment (a capsule
/// that may taper), if obstacles allow it; else the segment alone.
struct Segment {
  Vec3 p = Vec3::Zero();
  Vec3 q = Vec3::Zero();
  Room wanted = {};
  Room needed = {};  // at most `wanted`: tried if `wanted` does not fit
};

/// An axis-aligned box that is kept away from by `radius` (a sphere swept over it).
struct Obstacle {
  Vec3 lower = Vec3::Zero();
  Vec3 upper = Vec3::Zero();
  double radius = 0.0;
};

/// The least n . x over a box.
inline double support(const Vec3& n, const Vec3& lower, const Vec3& upper) {
  return n[0] * (n[0] > 0 ? lower[0] : upper[0]) + n[1] * (n[1] > 0 ? lower[1] : upper[1]) +
         n[2] * (n[2] > 0 ? lower[2] : upper[2]);
}
/// The least n . x over an obstacle, its sphere included. @pre n of unit length
inline double support(const Vec3& n, const Obstacle& o) {
  return support(n, o.lower, o.upper) - o.radius;
}

enum class Separation {
  roomy,    // with the balls that were needed in front, or those that were wanted
  thin,     // with the segment in front, but not the balls
  blocked,  // not at all: the segment enters the obstacle
};

/// A plane with the whole obstacle beyond it and the segment, with its balls if that is
/// possible, before it.
///
/// The normal starts as `towards` (where the ellipsoid touches the box) and turns towards the
/// direction in which segment and obstacle are farthest apart, only as far as needed.
Separation separate(const Vec3& towards, const Obstacle& obstacle, const Segment& segment,
                    const Margins& margins, Plane& plane);

/// How far obstacle and hull of the balls are apart; negative if they meet.
double clearance(const Obstacle& obstacle, const Segment& segment, const Room& room);
bool meets(const Obstacle& obstacle, const Segment& segment, const Room& room);

/// Where between p (0) and q (1) an obstacle is nearest, radii of `room` allowed for; the middle
/// of what is inside.
double nearest_parameter(const Obstacle& obstacle, const Segment& segment, const Room& room = {});

}  // namespace goshawk::corridor_builder
