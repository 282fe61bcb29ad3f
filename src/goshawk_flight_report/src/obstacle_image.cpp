#include "obstacle_image.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace goshawk::flight_report {

namespace {

int axis_size(const Index3& size, int axis) {
  return axis == 0 ? size.x : axis == 1 ? size.y : size.z;
}

/// A grid seen along w, its indices named by the picture's axes.
class Seen {
 public:
  Seen(const VoxelGrid& grid, const View& view) : grid_(grid), view_(view) {}

  int size(int axis) const { return axis_size(grid_.geometry.size, axis); }
  double origin(int axis) const { return grid_.geometry.origin_map[axis]; }
  double resolution() const { return grid_.geometry.resolution_m; }

  Index3 index(int u, int v, int w) const {
    int i[3] = {};
    i[view_.u] = u;
    i[view_.v] = v;
    i[view_.w] = w;
    return {i[0], i[1], i[2]};
  }
  bool known(Index3 i) const { return grid_.is_known(i); }
  /// Occupied because it was measured so, not because nobody looked.
  bool blocked(Index3 i) const { return grid_.grown.test(i) && known(i); }

  /// Index of a coordinate, clamped to the grid.
  int clamped(double coordinate, int axis) const {
    const double i = std::floor((coordinate - origin(axis)) / resolution());
    return int(std::clamp(i, 0.0, double(size(axis) - 1)));
  }

 private:
  const VoxelGrid& grid_;
  View view_;
};

/// Seen from the side, height counts little: above and below a place, that place's depth holds.
double nearest_depth(const std::vector<Vec3>& guide, const View& view, double u, double v) {
  const double weight_v = view.v == 2 ? 0.1 : 1.0;
  double best = std::numeric_limits<double>::infinity();
  double depth = 0.0;
  for (const Vec3& p : guide) {
    const double du = p[view.u] - u;
    const double dv = p[view.v] - v;
    const double d = du * du + weight_v * dv * dv;
    if (d < best) {
      best = d;
      depth = p[view.w];
    }
  }
  return depth;
}

Color mix(const Color& a, const Color& b, double t) {
  return {a.r + t * (b.r - a.r), a.g + t * (b.g - a.g), a.b + t * (b.b - a.b)};
}

struct Column {
  double share_blocked = 0.0;  // of all voxels along w
  double near_blocked = 0.0;   // of those at the depth flown nearby
  bool near_known = false;
};

Column look(const Seen& seen, const View& view, int u, int v, Interval depth) {
  const int from = seen.clamped(depth.lo, view.w);
  const int to = seen.clamped(depth.hi, view.w);
  Column column;
  const int size = seen.size(view.w);
  for (int w = 0; w < size; ++w) {
    const Index3 i = seen.index(u, v, w);
    const bool near = w >= from && w <= to;
    column.near_known = column.near_known || (near && seen.known(i));
    if (!seen.blocked(i)) continue;
    column.share_blocked += 1.0 / size;
    column.near_blocked += near ? 1.0 / (to - from + 1) : 0.0;
  }
  return column;
}

Color color_of(const Column& column, bool grown_there) {
  if (column.near_blocked > 0.0)
    return mix(kBlocked, {0.50, 0.54, 0.60}, 1.0 - column.near_blocked);
  if (grown_there) return kGrown;
  if (column.share_blocked > 0.0) {
    return mix({0.95, 0.955, 0.96}, {0.76, 0.78, 0.81}, std::sqrt(column.share_blocked));
  }
  return column.near_known ? Color{1, 1, 1} : kUnknown;
}

}  // namespace

ObstacleImage obstacle_image(const VoxelGrid* obstacles, const VoxelGrid* grown, const View& view,
                             const Interval& u, const Interval& v, const std::vector<Vec3>& guide,
                             double half_depth_m) {
  ObstacleImage result;
  const VoxelGrid* base = obstacles != nullptr ? obstacles : grown;
  if (base == nullptr) return result;
  const Seen seen(*base, view);
  const double edge_m = seen.resolution();
  const int u0 = seen.clamped(u.lo, view.u), u1 = seen.clamped(u.hi, view.u);
  const int v0 = seen.clamped(v.lo, view.v), v1 = seen.clamped(v.hi, view.v);
  result.u = {seen.origin(view.u) + edge_m * u0, seen.origin(view.u) + edge_m * (u1 + 1)};
  result.v = {seen.origin(view.v) + edge_m * v0, seen.origin(view.v) + edge_m * (v1 + 1)};
  result.image = {u1 - u0 + 1, v1 - v0 + 1, {}};
  result.image.pixels.reserve(std::size_t(result.image.width) * std::size_t(result.image.height));
  for (int iv = v1; iv >= v0; --iv) {
    for (int iu = u0; iu <= u1; ++iu) {
      Vec3 center = Vec3::Zero();
      center[view.u] = seen.origin(view.u) + edge_m * (iu + 0.5);
      center[view.v] = seen.origin(view.v) + edge_m * (iv + 0.5);
      center[view.w] = nearest_depth(guide, view, center[view.u], center[view.v]);
      const Interval whole{-1e9, 1e9};
      const Interval near{center[view.w] - half_depth_m, center[view.w] + half_depth_m};
      const Column column = look(seen, view, iu, iv, guide.empty() ? whole : near);
      bool grown_there = false;
      if (grown != nullptr && !guide.empty()) {
        const auto i = grown->geometry.index_of(center);
        grown_there = i && grown->grown.test(*i) && grown->is_known(*i);
      }
      result.image.pixels.push_back(packed(color_of(column, grown_there)));
    }
  }
  return result;
}

}  // namespace goshawk::flight_report
