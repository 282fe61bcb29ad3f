#include "ray_walk.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace goshawk::map_server {
namespace {

// Where a ray is along its rows at the faces across another axis: the first place, and the way
// between two of them. No place lies beyond the ray's ends.
struct Places {
  std::int64_t next, advance;

  Places(const Ray& ray, const Crossings& c)
      : next(at(ray, ray.from.x(), c.next)), advance(c.count < 2 ? 0 : at(ray, 0.0, c.every)) {
    const std::int64_t low = std::int64_t{std::min(ray.x.first, ray.x.last)} << RayWalk::kFraction;
    const std::int64_t high =
        ((std::int64_t{std::max(ray.x.first, ray.x.last)} + 1) << RayWalk::kFraction) - 1;
    next = std::clamp(next, low, high);
    if (c.count < 2) return;
    const std::int64_t last = next + (c.count - 1) * advance;
    if (last < low || last > high) advance = (std::clamp(last, low, high) - next) / (c.count - 1);
  }

 private:
  static std::int64_t at(const Ray& ray, double from, std::int64_t time) {
    const double voxels = from + ray.way.x() * (double(time) / double(Crossings::kEnd));
    return std::int64_t(voxels * double(std::int64_t{1} << RayWalk::kFraction));
  }
};

template <bool kUp>
void walk_to_end(const RowBits& bits, RayWalk& walk) {
  while (walk.rows_left > 0) {
    const std::int64_t row = walk.row, x = walk.x;
    walk.step<kUp>();
    bits.put(row, kUp ? x : walk.x, kUp ? walk.x : x);
  }
  if (kUp ? walk.x < walk.last_x : walk.x > walk.last_x) {
    bits.put(walk.row, kUp ? walk.x : walk.last_x + 1, kUp ? walk.last_x - 1 : walk.x);
  }
}

template <bool kUp>
void walk_each(const RowBits& bits, std::span<RayWalk> walks,
               std::span<const std::uint16_t> order) {
  for (const std::uint16_t k : order) walk_to_end<kUp>(bits, walks[k]);
}

}  // namespace

RayWalk::RayWalk(const Ray& ray, Index3 last, std::int64_t size_y)
    : until_z(ray.z.next - ray.y.next),
      every_y(ray.y.every),
      both(ray.y.every + ray.z.every),
      row(ray.z.first * size_y + ray.y.first),
      row_y(ray.y.step),
      row_more(ray.z.step * size_y - ray.y.step),
      x(ray.x.first),
      last_x(last.x),
      rows_left(std::abs(last.y - ray.y.first) + std::abs(last.z - ray.z.first)) {
  const Places at_y(ray, ray.y), at_z(ray, ray.z);
  place_y = at_y.next;
  place_z = at_z.next;
  advance_y = at_y.advance;
  advance_z = at_z.advance;
}

void walk_rows(const RowBits& bits, std::span<RayWalk> walks, std::span<const std::uint16_t> order,
               bool up) {
  up ? walk_each<true>(bits, walks, order) : walk_each<false>(bits, walks, order);
}

}  // namespace goshawk::map_server
