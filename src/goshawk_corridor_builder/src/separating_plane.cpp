#include "separating_plane.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

namespace goshawk::corridor_builder {
namespace {

Vec3 point_at(const Segment& s, double t) {
  return s.p + t * (s.q - s.p);
}

Vec3 to_box(const Vec3& x, const Vec3& lower, const Vec3& upper) {
  return x.cwiseMax(lower).cwiseMin(upper) - x;
}

double gap(const Vec3& n, const Vec3& lower, const Vec3& upper, const Segment& s) {
  return support(n, lower, upper) - std::max(n.dot(s.p), n.dot(s.q));
}

struct Direction {
  Vec3 normal = Vec3::UnitX();
  double gap = -std::numeric_limits<double>::infinity();

  void offer(const Vec3& candidate, const Vec3& lower, const Vec3& upper, const Segment& s) {
    const double length = candidate.norm();
    if (!(length > 1e-9)) return;
    const Vec3 n = candidate / length;
    const double g = corridor_builder::gap(n, lower, upper, s);
    if (g <= gap) return;
    gap = g;
    normal = n;
  }
};

// Segment and box interiors are disjoint exactly where one of these axes separates them: the
// face normals, and the edges' cross products with the segment (separating axis theorem).
void offer_axes(const Vec3& lower, const Vec3& upper, const Segment& s, Direction& best) {
  const Vec3 along = (s.q - s.p).norm() > 1e-9 ? Vec3((s.q - s.p).normalized()) : Vec3::Zero();
  for (int axis = 0; axis < 3; ++axis) {
    const Vec3 unit = Vec3::Unit(axis);
    best.offer(unit, lower, upper, s);
    best.offer(-unit, lower, upper, s);
  }
  for (int axis = 0; axis < 3; ++axis) {
    const Vec3 normal = Vec3::Unit(axis).cross(along);
    best.offer(normal, lower, upper, s);
    best.offer(-normal, lower, upper, s);
  }
}

// The direction in which both ends keep farthest: the least distance, or, where that is too
// small to have a direction, the best separating axis.
Direction clearest_direction(const Vec3& lower, const Vec3& upper, const Segment& s) {
  Direction best;
  const Vec3 x = point_at(s, nearest_parameter(s, lower, upper));
  const Vec3 towards = to_box(x, lower, upper);
  if (towards.norm() > 1e-6) best.offer(towards, lower, upper, s);
  if (!(best.gap > 1e-6)) offer_axes(lower, upper, s, best);
  return best;
}

}  // namespace

Margins Margins::for_coordinates(double largest_coordinate) {
  Margins m;
  m.rounding = 64.0 * std::numeric_limits<double>::epsilon() * (largest_coordinate + 16.0);
  m.plane = std::max(1e-7, 16.0 * m.rounding);
  m.touch = std::max(1e-9, 4.0 * m.rounding);
  return m;
}

// The squared distance along the segment is convex; its slope is bisected.
double nearest_parameter(const Segment& s, const Vec3& lower, const Vec3& upper) {
  const Vec3 d = s.q - s.p;
  auto slope = [&](double t) { return -d.dot(to_box(point_at(s, t), lower, upper)); };
  if (slope(0.0) > 0.0) return 0.0;
  if (slope(1.0) < 0.0) return 1.0;
  double first = 0.0, last = 1.0;  // where the slope stops being negative, starts being positive
  double hi = 1.0;
  for (int k = 0; k < 40; ++k) {
    const double t = 0.5 * (first + hi);
    (slope(t) < 0.0 ? first : hi) = t;
  }
  double lo = first;
  for (int k = 0; k < 40; ++k) {
    const double t = 0.5 * (lo + last);
    (slope(t) > 0.0 ? last : lo) = t;
  }
  return 0.5 * (first + last);
}

bool separate(const Vec3& wanted, const Vec3& lower, const Vec3& upper, const Segment& segment,
              double wanted_slack, const Margins& margins, Plane& plane) {
  Vec3 normal = wanted.normalized();
  double room = gap(normal, lower, upper, segment);
  if (!(room >= wanted_slack)) {
    const Direction clearest = clearest_direction(lower, upper, segment);
    if (!(clearest.gap >= -margins.touch)) return false;
    const double least = std::min(wanted_slack, 0.9 * clearest.gap);
    if (!(room >= least)) {
      double lo = 0.0, hi = 1.0;  // how far turned: too little, enough
      for (int k = 0; k < 6; ++k) {
        const double t = 0.5 * (lo + hi);
        const Vec3 n = ((1.0 - t) * normal + t * clearest.normal);
        const double length = n.norm();
        (length > 1e-6 && gap(n / length, lower, upper, segment) >= least ? hi : lo) = t;
      }
      const Vec3 turned = (1.0 - hi) * normal + hi * clearest.normal;
      normal = hi < 1.0 ? Vec3(turned.normalized()) : clearest.normal;
      room = gap(normal, lower, upper, segment);
    }
  }
  plane.normal = normal;
  plane.tight = room < 2.0 * margins.plane;
  plane.offset =
      support(normal, lower, upper) - (plane.tight ? 2.0 * margins.rounding : margins.plane);
  return true;
}

}  // namespace goshawk::corridor_builder
