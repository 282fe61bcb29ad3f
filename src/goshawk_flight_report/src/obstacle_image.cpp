#include "obstacle_image.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace goshawk::flight_report {

namespace {

struct Range {
  int first = 0;
  int last = -1;
  int count() const { return last - first + 1; }
};

/// A grid seen along w, its indices named by the picture's axes.
class Seen {
 public:
  Seen(const VoxelGrid& grid, const View& view) : grid_(grid), view_(view) {}

  /// The voxels of an interval along an axis, clamped to the grid.
  Range range(const Interval& interval, int axis) const {
    return {clamped(interval.lo, axis), clamped(interval.hi, axis)};
  }
  Interval metres(const Range& range, int axis) const {
    return {origin(axis) + edge() * range.first, origin(axis) + edge() * (range.last + 1)};
  }
  double middle(int i, int axis) const { return origin(axis) + edge() * (i + 0.5); }
  int depth() const { return size(view_.w); }

  bool known(int u, int v, int w) const { return grid_.is_known(index(u, v, w)); }
  /// Occupied because it was measured so, not because nobody looked.
  bool blocked(int u, int v, int w) const {
    const Index3 i = index(u, v, w);
    return grid_.grown.test(i) && grid_.is_known(i);
  }

 private:
  double origin(int axis) const { return grid_.geometry.origin_map[axis]; }
  double edge() const { return grid_.geometry.resolution_m; }
  int size(int axis) const {
    const Index3& n = grid_.geometry.size;
    return axis == 0 ? n.x : axis == 1 ? n.y : n.z;
  }
  int clamped(double coordinate, int axis) const {
    const double i = std::floor((coordinate - origin(axis)) / edge());
    return int(std::clamp(i, 0.0, double(size(axis) - 1)));
  }
  Index3 index(int u, int v, int w) const {
    int i[3] = {};
    i[view_.u] = u;
    i[view_.v] = v;
    i[view_.w] = w;
    return {i[0], i[1], i[2]};
  }

  const VoxelGrid& grid_;
  View view_;
};

/// The point of the guide nearest in the picture. Seen from the side, height counts little: above
/// and below a place, that place's depth holds. @pre guide not empty
const Vec3& nearest(const std::vector<Vec3>& guide, const View& view, const Vec3& cell) {
  const double weight_v = view.v == 2 ? 0.1 : 1.0;
  return *std::ranges::min_element(guide, {}, [&](const Vec3& p) {
    const double du = p[view.u] - cell[view.u];
    const double dv = p[view.v] - cell[view.v];
    return du * du + weight_v * dv * dv;
  });
}

std::uint32_t packed(const Color& c) {
  const auto byte = [](double x) { return std::uint32_t(std::lround(255.0 * x)); };
  return byte(c.r) << 16 | byte(c.g) << 8 | byte(c.b);
}

Color mix(const Color& a, const Color& b, double t) {
  return {a.r + t * (b.r - a.r), a.g + t * (b.g - a.g), a.b + t * (b.b - a.b)};
}

/// @param near the depths that count as flown @param grown_there blocked for the vehicle's centre
Color color_of(const Seen& seen, int u, int v, const Range& near, bool grown_there) {
  int blocked = 0, blocked_near = 0;
  bool known_near = false;
  for (int w = 0; w < seen.depth(); ++w) {
    const bool is_near = w >= near.first && w <= near.last;
    known_near = known_near || (is_near && seen.known(u, v, w));
    if (!seen.blocked(u, v, w)) continue;
    ++blocked;
    blocked_near += is_near;
  }
  if (blocked_near > 0) {
    return mix(kBlocked, {0.50, 0.54, 0.60}, 1.0 - double(blocked_near) / near.count());
  }
  if (grown_there) return kGrown;
  if (blocked > 0) {
    const double share = double(blocked) / seen.depth();
    return mix({0.95, 0.955, 0.96}, {0.76, 0.78, 0.81}, std::sqrt(share));
  }
  return known_near ? kWhite : kUnknown;
}

}  // namespace

ObstacleImage obstacle_image(const VoxelGrid* obstacles, const VoxelGrid* grown, const View& view,
                             const Interval& u, const Interval& v, const std::vector<Vec3>& guide,
                             double half_depth_m) {
  const VoxelGrid* base = obstacles != nullptr ? obstacles : grown;
  if (base == nullptr) return {};
  const Seen seen(*base, view);
  const Range columns = seen.range(u, view.u), rows = seen.range(v, view.v);
  ObstacleImage result{
      {columns.count(), {}}, seen.metres(columns, view.u), seen.metres(rows, view.v)};
  for (int iv = rows.last; iv >= rows.first; --iv) {
    for (int iu = columns.first; iu <= columns.last; ++iu) {
      Range near{0, seen.depth() - 1};
      bool grown_there = false;
      if (!guide.empty()) {
        Vec3 cell = Vec3::Zero();
        cell[view.u] = seen.middle(iu, view.u);
        cell[view.v] = seen.middle(iv, view.v);
        const double depth = cell[view.w] = nearest(guide, view, cell)[view.w];
        near = seen.range({depth - half_depth_m, depth + half_depth_m}, view.w);
        const auto i = grown != nullptr ? grown->geometry.index_of(cell) : std::nullopt;
        grown_there = i && grown->grown.test(*i) && grown->is_known(*i);
      }
      result.image.pixels.push_back(packed(color_of(seen, iu, iv, near, grown_there)));
    }
  }
  return result;
}

}  // namespace goshawk::flight_report
