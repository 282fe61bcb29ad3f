#include "mesh_raster.hpp"

#include <algorithm>
#include <cmath>

namespace goshawk::map_server {
namespace {

// Cubes are [i - kEdge, i + 1 - kEdge]: they cover space without a gap, and a triangle that lies on
// the raster, but for rounding, has its cubes above it.
constexpr double kEdge = 1e-6;
constexpr double kRounding = 1e-9;  // [voxel edges] of cut corners

struct Layers {
  int first, last;
};

// The layers of cubes that meet [lo, hi], of n. Compared as doubles first: a cast of a huge value
// to int is undefined.
Layers layers_met(double lo, double hi, int n) {
  const double first = std::max(0.0, std::floor(lo + kEdge - kRounding));
  const double last = std::min(double(n - 1), std::floor(hi + kEdge + kRounding));
  if (!(first <= last)) return {0, -1};
  return {int(first), int(last)};
}

// A convex polygon: a triangle, cut by up to four planes, each of which adds one corner at most.
struct Polygon {
  std::array<Vec3, 7> corners;
  std::size_t size = 0;

  void add(const Vec3& p) {
    if (size < corners.size()) corners[size++] = p;
  }
  double least(int axis) const {
    double value = corners[0][axis];
    for (std::size_t i = 1; i < size; ++i) value = std::min(value, corners[i][axis]);
    return value;
  }
  double most(int axis) const {
    double value = corners[0][axis];
    for (std::size_t i = 1; i < size; ++i) value = std::max(value, corners[i][axis]);
    return value;
  }
};

// The part with side * p[axis] <= side * bound (Sutherland and Hodgman 1974).
Polygon cut(const Polygon& polygon, int axis, double side, double bound) {
  Polygon kept;
  for (std::size_t i = 0; i < polygon.size; ++i) {
    const Vec3& p = polygon.corners[i];
    const Vec3& q = polygon.corners[(i + 1) % polygon.size];
    const double p_out = side * (p[axis] - bound), q_out = side * (q[axis] - bound);
    if (p_out <= 0.0) kept.add(p);
    if ((p_out < 0.0 && q_out > 0.0) || (p_out > 0.0 && q_out < 0.0)) {
      Vec3 crossing = p + p_out / (p_out - q_out) * (q - p);
      crossing[axis] = bound;
      kept.add(crossing);
    }
  }
  return kept;
}

// The part within one layer of cubes, with slack: rounding must not lose a polygon that touches.
Polygon layer(const Polygon& polygon, int axis, int i) {
  const Polygon below = cut(polygon, axis, 1.0, i + 1 - kEdge + kRounding);
  return cut(below, axis, -1.0, i - kEdge - kRounding);
}

}  // namespace

void rasterise(const std::array<Vec3, 3>& corners, BitGrid& occupied) {
  const Index3 n = occupied.size();
  Polygon triangle;
  for (const Vec3& p : corners) triangle.add(p);
  const Layers zs = layers_met(triangle.least(2), triangle.most(2), n.z);
  for (int z = zs.first; z <= zs.last; ++z) {
    const Polygon slab = layer(triangle, 2, z);
    if (slab.size == 0) continue;
    const Layers ys = layers_met(slab.least(1), slab.most(1), n.y);
    for (int y = ys.first; y <= ys.last; ++y) {
      const Polygon row = layer(slab, 1, y);
      if (row.size == 0) continue;
      const Layers xs = layers_met(row.least(0), row.most(0), n.x);
      if (xs.first <= xs.last) occupied.set_run(xs.first, xs.last + 1, y, z, true);
    }
  }
}

}  // namespace goshawk::map_server
