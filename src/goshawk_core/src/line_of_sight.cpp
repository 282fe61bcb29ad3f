#include "goshawk/core/line_of_sight.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>
#include <utility>

namespace goshawk {
namespace {

constexpr double kSlack = 1e-9;       // [voxel edges] a cube this near to the segment counts as met
constexpr double kWellInside = 1e-6;  // [voxel edges] no rounding leaves the grid from there

struct IndexRange {
  int first;
  int last;
};

// The voxels that a walk may visit. A walk through a grid whose outside is free is kept to the
// grid, so that no segment, however long, takes longer than the grid is wide.
struct Bounds {
  Index3 first;
  Index3 last;

  IndexRange axis(int i) const {
    const int lo[] = {first.x, first.y, first.z};
    const int hi[] = {last.x, last.y, last.z};
    return {lo[i], hi[i]};
  }
};

// std::floor and std::ceil are calls on machines without SSE 4.1. @pre x fits an int
int int_floor(double x) {
  const int i = int(x);
  return i - (x < i);
}
int int_ceil(double x) {
  const int i = int(x);
  return i + (x > i);
}

// Indices within bounds of the closed unit intervals [i, i + 1] that meet the closed interval
// [lo, hi]. Compared as doubles first: a cast of a huge value to int is undefined.
IndexRange intervals_met(double lo, double hi, IndexRange bounds) {
  const double low = lo - kSlack, high = hi + kSlack;
  if (!(low <= double(bounds.last) + 1.0 && high >= double(bounds.first))) return {0, -1};
  return {low <= double(bounds.first) ? bounds.first : int_ceil(low) - 1,
          high >= double(bounds.last) ? bounds.last : int_floor(high)};
}

struct Interval {
  double lo;
  double hi;
};

// The part of the segment a + t d, t in [t0, t1], whose coordinate `axis` lies in [lo, hi], as an
// interval of t; empty (lo > hi) if there is none.
// @param inverse 1 / d, element by element
Interval clip(const Vec3& a, const Vec3& d, const Vec3& inverse, int axis, double lo, double hi,
              Interval t) {
  if (std::abs(d[axis]) < 1e-15) {
    return a[axis] >= lo && a[axis] <= hi ? t : Interval{1.0, 0.0};
  }
  double u = (lo - a[axis]) * inverse[axis];
  double v = (hi - a[axis]) * inverse[axis];
  if (u > v) std::swap(u, v);
  return {std::max(t.lo, u), std::min(t.hi, v)};
}

Interval extent(const Vec3& a, const Vec3& d, int axis, Interval t) {
  const double u = a[axis] + d[axis] * t.lo;
  const double v = a[axis] + d[axis] * t.hi;
  return {std::min(u, v), std::max(u, v)};
}

// Slabs along the longest axis, rows within a slab, voxels within a row: each cut is taken of
// the segment itself, with slack, so that no cube that is met is missed.
template <typename Visit>  // bool Visit(Index3): false stops
bool walk(const Vec3& a, const Vec3& b, const Bounds& bounds, const Visit& visit) {
  const Vec3 d = b - a;
  const Vec3 inverse = d.cwiseInverse();
  int u = 0;
  d.cwiseAbs().maxCoeff(&u);
  const int v = (u + 1) % 3;
  const int w = (u + 2) % 3;
  const Interval whole{0.0, 1.0};
  const Interval along = extent(a, d, u, whole);
  const IndexRange slabs = intervals_met(along.lo, along.hi, bounds.axis(u));
  const bool forward = d[u] >= 0.0;
  for (int n = 0; n <= slabs.last - slabs.first; ++n) {
    const int i = forward ? slabs.first + n : slabs.last - n;
    const Interval t = clip(a, d, inverse, u, i - kSlack, i + 1 + kSlack, whole);
    if (t.lo > t.hi) continue;
    const Interval across = extent(a, d, v, t);
    const IndexRange rows = intervals_met(across.lo, across.hi, bounds.axis(v));
    for (int j = rows.first; j <= rows.last; ++j) {
      // Mostly one row holds all of the segment in the slab.
      const bool whole_row = across.lo >= j - kSlack && across.hi <= j + 1 + kSlack;
      const Interval s = whole_row ? t : clip(a, d, inverse, v, j - kSlack, j + 1 + kSlack, t);
      if (s.lo > s.hi) continue;
      const Interval rest = extent(a, d, w, s);
      const IndexRange cells = intervals_met(rest.lo, rest.hi, bounds.axis(w));
      for (int k = cells.first; k <= cells.last; ++k) {
        int index[3];
        index[u] = i;
        index[v] = j;
        index[w] = k;
        if (!visit(Index3{index[0], index[1], index[2]})) return false;
      }
    }
  }
  return true;
}

// What line_is_free does for segments whose ends lie inside, for speed: no index needs bounds, and
// mostly one voxel holds all of the segment in a slab.
// @tparam u the segment's longest axis, along which it is not a point
template <int u>
class InsideWalk {
 public:
  InsideWalk(const BitGrid& blocked, const Vec3& a, const Vec3& d)
      : blocked_(blocked), a_(a), d_(d), inverse_(d.cwiseInverse()) {}

  bool is_free() const {
    const IndexRange slabs = met(a_[u], a_[u] + d_[u]);
    const bool forward = d_[u] >= 0.0;
    for (int n = 0; n <= slabs.last - slabs.first; ++n) {
      if (!slab_is_free(forward ? slabs.first + n : slabs.last - n)) return false;
    }
    return true;
  }

 private:
  static constexpr int v = (u + 1) % 3;
  static constexpr int w = (u + 2) % 3;

  bool slab_is_free(int i) const {
    const double low = (i - kSlack - a_[u]) * inverse_[u];
    const double high = (i + 1 + kSlack - a_[u]) * inverse_[u];
    const Interval t{std::max(0.0, std::min(low, high)), std::min(1.0, std::max(low, high))};
    if (t.lo > t.hi) return true;
    const IndexRange rows = met(a_[v] + d_[v] * t.lo, a_[v] + d_[v] * t.hi);
    const IndexRange cells = met(a_[w] + d_[w] * t.lo, a_[w] + d_[w] * t.hi);
    if (rows.first == rows.last) return row_is_free(i, rows.first, cells);
    for (int j = rows.first; j <= rows.last; ++j) {
      const Interval s = clip(a_, d_, inverse_, v, j - kSlack, j + 1 + kSlack, t);
      if (s.lo > s.hi) continue;
      if (!row_is_free(i, j, met(a_[w] + d_[w] * s.lo, a_[w] + d_[w] * s.hi))) return false;
    }
    return true;
  }

  bool row_is_free(int i, int j, IndexRange cells) const {
    for (int k = cells.first; k <= cells.last; ++k) {
      int index[3];
      index[u] = i;
      index[v] = j;
      index[w] = k;
      if (blocked_.get({index[0], index[1], index[2]})) return false;
    }
    return true;
  }

  // The indices whose closed unit intervals meet the one between x and y.
  static IndexRange met(double x, double y) {
    return {int_ceil(std::min(x, y) - kSlack) - 1, int_floor(std::max(x, y) + kSlack)};
  }

  const BitGrid& blocked_;
  const Vec3 a_, d_, inverse_;
};

// Is any of a few points of the segment in a blocked voxel? Most blocked segments are found out so.
bool blocked_at_samples(const BitGrid& blocked, const Vec3& a, const Vec3& d) {
  constexpr double kSamples[] = {0.5, 0.25, 0.75, 0.125, 0.625, 0.375, 0.875};
  for (const double t : kSamples) {
    if (blocked.get({int(a.x() + t * d.x()), int(a.y() + t * d.y()), int(a.z() + t * d.z())})) {
      return true;
    }
  }
  return false;
}

// @pre both ends inside by kWellInside @return nothing for a segment that is a point
std::optional<bool> inside_line_is_free(const BitGrid& blocked, const Vec3& a, const Vec3& b) {
  constexpr double kLong = 4.0;  // [voxel edges] shorter ones are walked as soon
  const Vec3 d = b - a;
  int u = 0;
  const double length = d.cwiseAbs().maxCoeff(&u);
  if (length < 1e-15) return std::nullopt;
  if (length > kLong && blocked_at_samples(blocked, a, d)) return false;
  if (u == 0) return InsideWalk<0>(blocked, a, d).is_free();
  if (u == 1) return InsideWalk<1>(blocked, a, d).is_free();
  return InsideWalk<2>(blocked, a, d).is_free();
}

// Is p inside by more than the margin? By kSlack: no voxel beyond the grid is met there.
bool inside(const Vec3& p, Index3 size, double margin) {
  const Vec3 upper(size.x, size.y, size.z);
  return (p.array() > margin).all() && (p.array() < upper.array() - margin).all();
}

}  // namespace

bool line_is_free(const BitGrid& blocked, const Vec3& a, const Vec3& b) {
  // Nothing is known of a segment that is not finite, so it is not free.
  if (!is_finite(a) || !is_finite(b)) return false;
  const Index3 size = blocked.size();
  if (inside(a, size, kWellInside) && inside(b, size, kWellInside)) {
    if (const auto is_free = inside_line_is_free(blocked, a, b)) return *is_free;
  }
  if (blocked.outside() && !(inside(a, size, kSlack) && inside(b, size, kSlack))) return false;
  const Bounds bounds{{0, 0, 0}, size - Index3{1, 1, 1}};
  return walk(a, b, bounds, [&](Index3 i) { return !blocked.get(i); });
}

bool line_is_free(const VoxelGrid& grid, const Vec3& a_map, const Vec3& b_map) {
  return line_is_free(grid.grown, grid.geometry.to_grid(a_map), grid.geometry.to_grid(b_map));
}

void supercover(const Vec3& a, const Vec3& b, std::vector<Index3>& cells) {
  constexpr int far = 1 << 30;
  if (!((a.array().abs() < far).all() && (b.array().abs() < far).all())) {
    throw std::invalid_argument("supercover() of a segment that is not finite, or too far away");
  }
  cells.clear();
  walk(a, b, Bounds{{-far, -far, -far}, {far, far, far}}, [&](Index3 i) {
    cells.push_back(i);
    return true;
  });
}

std::vector<Index3> supercover(const Vec3& a, const Vec3& b) {
  std::vector<Index3> cells;
  supercover(a, b, cells);
  return cells;
}

}  // namespace goshawk
