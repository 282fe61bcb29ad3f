#include "separating_plane.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

namespace goshawk::corridor_builder {
namespace {

constexpr double kShare = 0.9;  // of the least distance that a plane leaves a thin segment

Vec3 point_at(const Segment& s, double t) {
  return s.p + t * (s.q - s.p);
}

Vec3 to_box(const Vec3& x, const Obstacle& o) {
  return x.cwiseMax(o.lower).cwiseMin(o.upper) - x;
}

double gap(const Vec3& n, const Obstacle& o, const Segment& s, const Room& room) {
  return support(n, o) - std::max(n.dot(s.p) + room.p, n.dot(s.q) + room.q);
}

struct Direction {
  Vec3 normal = Vec3::UnitX();
  double gap = -std::numeric_limits<double>::infinity();

  void offer(const Vec3& candidate, const Obstacle& o, const Segment& s, const Room& room) {
    const double length = candidate.norm();
    if (!(length > 1e-9)) return;
    const Vec3 n = candidate / length;
    const double g = corridor_builder::gap(n, o, s, room);
    if (g <= gap) return;
    gap = g;
    normal = n;
  }
};

// Segment and box interiors are disjoint exactly where one of these axes separates them: the
// face normals, and the edges' cross products with the segment (separating axis theorem).
void offer_axes(const Obstacle& o, const Segment& s, const Room& room, Direction& best) {
  const Vec3 along = (s.q - s.p).norm() > 1e-9 ? Vec3((s.q - s.p).normalized()) : Vec3::Zero();
  for (int axis = 0; axis < 3; ++axis) {
    const Vec3 unit = Vec3::Unit(axis);
    best.offer(unit, o, s, room);
    best.offer(-unit, o, s, room);
  }
  for (int axis = 0; axis < 3; ++axis) {
    const Vec3 normal = Vec3::Unit(axis).cross(along);
    best.offer(normal, o, s, room);
    best.offer(-normal, o, s, room);
  }
}

// The direction in which both ends keep farthest: the least distance, or, if that is too
// small to have a direction, the best separating axis.
Direction clearest_direction(const Obstacle& o, const Segment& s, const Room& room) {
  Direction best;
  const Vec3 x = point_at(s, nearest_parameter(o, s, room));
  const Vec3 towards = to_box(x, o);
  if (towards.norm() > 1e-6) best.offer(towards, o, s, room);
  const double apart = best.gap + o.radius + std::min(room.p, room.q);
  if (!(apart > 1e-6)) offer_axes(o, s, room, best);
  return best;
}

// As little of the way from `normal` to `clearest` as leaves `least`. @pre clearest leaves it
Vec3 turned(const Vec3& normal, const Vec3& clearest, const Obstacle& o, const Segment& s,
            const Room& room, double least) {
  double lo = 0.0, hi = 1.0;  // too little, enough
  for (int k = 0; k < 6; ++k) {
    const double t = 0.5 * (lo + hi);
    const Vec3 n = (1.0 - t) * normal + t * clearest;
    const double length = n.norm();
    (length > 1e-6 && gap(n / length, o, s, room) >= least ? hi : lo) = t;
  }
  return hi < 1.0 ? Vec3(((1.0 - hi) * normal + hi * clearest).normalized()) : clearest;
}

Separation choose_normal(Vec3& normal, const Obstacle& o, const Segment& s,
                         const Margins& margins) {
  if (gap(normal, o, s, s.wanted) >= 0.0) return Separation::roomy;
  for (const Room& room : {s.wanted, s.needed}) {
    const Direction clearest = clearest_direction(o, s, room);
    if (!(clearest.gap >= 0.0)) continue;
    normal = turned(normal, clearest.normal, o, s, room, 0.0);
    return Separation::roomy;
  }
  const Direction clearest = clearest_direction(o, s, {});
  if (!(clearest.gap >= -margins.touch)) return Separation::blocked;
  const double least = kShare * clearest.gap;
  if (!(gap(normal, o, s, {}) >= least)) {
    normal = turned(normal, clearest.normal, o, s, {}, least);
  }
  return Separation::thin;
}

// The slope along the segment of (distance to the box - radius), up to a factor above zero.
struct Slope {
  const Obstacle& obstacle;
  const Segment& segment;
  Vec3 along;
  double taper;

  double operator()(double t) const {
    const Vec3 way = to_box(point_at(segment, t), obstacle);
    const double slope = -along.dot(way);
    return taper == 0.0 ? slope : slope - taper * way.norm();
  }
};

// Without taper the slope is linear between the planes of the box's faces, and never falls.
// @return the middle of where it is zero. @pre slope(0) <= 0 <= slope(1)
double root_of_pieces(const Slope& slope) {
  double t[8] = {0.0};
  int n = 1;
  for (int a = 0; a < 3; ++a) {
    const double d = slope.along[a];
    if (std::abs(d) < 1e-12) continue;
    for (const double face : {slope.obstacle.lower[a], slope.obstacle.upper[a]}) {
      const double at = (face - slope.segment.p[a]) / d;
      if (!(at > 0.0 && at < 1.0)) continue;
      int k = n++;
      for (; t[k - 1] > at; --k) t[k] = t[k - 1];  // t[0] is 0
      t[k] = at;
    }
  }
  t[n++] = 1.0;
  double first = 0.0, last = 1.0;  // of the roots
  double value = slope(0.0);
  for (int i = 1; i < n; ++i) {
    const double next = slope(t[i]);
    const double root = t[i - 1] - value * (t[i] - t[i - 1]) / (next - value);
    if (value < 0.0 && next >= 0.0) first = root;
    if (value <= 0.0 && next > 0.0) {
      last = root;
      break;
    }
    value = next;
  }
  return 0.5 * (first + last);
}

// The distance less a radius that changes along the segment: convex, its slope is bisected.
double root_by_halving(const Slope& slope) {
  double lo = 0.0, hi = 1.0;
  for (int k = 0; k < 40; ++k) {
    const double t = 0.5 * (lo + hi);
    (slope(t) < 0.0 ? lo : hi) = t;
  }
  return hi;
}

}  // namespace

Margins Margins::for_coordinates(double largest_coordinate) {
  Margins m;
  m.rounding = 64.0 * std::numeric_limits<double>::epsilon() * (largest_coordinate + 16.0);
  m.plane = std::max(1e-7, 16.0 * m.rounding);
  m.touch = std::max(1e-9, 4.0 * m.rounding);
  return m;
}

double nearest_parameter(const Obstacle& o, const Segment& s, const Room& room) {
  const Slope slope{o, s, s.q - s.p, room.q - room.p};
  if (slope(0.0) > 0.0) return 0.0;
  if (slope(1.0) < 0.0) return 1.0;
  return slope.taper == 0.0 ? root_of_pieces(slope) : root_by_halving(slope);
}

bool meets(const Obstacle& o, const Segment& s, const Room& room) {
  const double reach = std::max(room.p, room.q) + o.radius;
  for (int a = 0; a < 3; ++a) {
    if (o.lower[a] - reach >= std::max(s.p[a], s.q[a])) return false;
    if (o.upper[a] + reach <= std::min(s.p[a], s.q[a])) return false;
  }
  const double apart = clearance(o, s, {});  // mostly enough, and cheap: no taper
  if (apart >= std::max(room.p, room.q)) return false;
  return apart < std::min(room.p, room.q) || clearance(o, s, room) < 0.0;
}

double clearance(const Obstacle& o, const Segment& s, const Room& room) {
  const double t = nearest_parameter(o, s, room);
  const Vec3 way = to_box(point_at(s, t), o);
  return way.norm() - o.radius - ((1.0 - t) * room.p + t * room.q);
}

Separation separate(const Vec3& towards, const Obstacle& obstacle, const Segment& segment,
                    const Margins& margins, Plane& plane) {
  Vec3 normal = towards.normalized();
  const Separation result = choose_normal(normal, obstacle, segment, margins);
  if (result == Separation::blocked) return result;
  const double room = gap(normal, obstacle, segment, {});
  plane.normal = normal;
  plane.tight = room < 2.0 * margins.plane;
  plane.offset = support(normal, obstacle) - (plane.tight ? 2.0 * margins.rounding : margins.plane);
  return result;
}

}  // namespace goshawk::corridor_builder
