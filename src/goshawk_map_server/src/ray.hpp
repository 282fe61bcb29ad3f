#pragma once

#include <algorithm>
#include <cstdint>
#include <cstdlib>

#include "goshawk/core/grid_geometry.hpp"
#include "goshawk/core/vector.hpp"

namespace goshawk::map_server {

/// When a ray crosses the faces across one axis. It goes from time 0 to kEnd; times are integers,
/// so that sums of them are exact.
struct Crossings {
  static constexpr std::int64_t kEnd = std::int64_t{1} << 60;
  static constexpr std::int64_t kNever = std::int64_t{1} << 61;  // longest time between two faces

  int first, last;           // voxels at the ends
  int count, step;           // faces between them, and the direction
  std::int64_t next = kEnd;  // time of the first one
  std::int64_t every = kEnd;

  /// @param from, to [voxels] within 2^30 of 0
  Crossings(double from, double to)
      : first(below(from)),
        last(below(to)),
        count(std::abs(last - first)),
        step(to < from ? -1 : 1) {
    if (count == 0) return;
    const double way = to - from;
    const double period = double(kEnd) / std::abs(way);
    const double ahead = way > 0.0 ? double(first) + 1.0 - from : from - double(first);
    every = std::int64_t(std::min(period, double(kNever)));
    // Rounding must neither lose nor add a face: the last one comes before the end, the next after.
    const std::int64_t least = kEnd - count * every;
    next = std::clamp(std::int64_t(std::min(ahead * period, double(kNever))), least,
                      least + every - 1);
  }

  std::int64_t last_time() const { return count == 0 ? -kNever : next + (count - 1) * every; }

 private:
  // std::floor is a call unless the processor is known to have an instruction for it.
  static int below(double x) {
    const int towards_0 = int(x);
    return towards_0 - int(x < double(towards_0));
  }
};

/// A straight line through voxels, from one place to another.
struct Ray {
  Vec3 from, way;
  Crossings x, y, z;

  Ray(const Vec3& a, const Vec3& b)
      : from(a), way(b - a), x(a.x(), b.x()), y(a.y(), b.y()), z(a.z(), b.z()) {}

  Index3 first() const { return {x.first, y.first, z.first}; }
  Index3 last() const { return {x.last, y.last, z.last}; }
};

}  // namespace goshawk::map_server
