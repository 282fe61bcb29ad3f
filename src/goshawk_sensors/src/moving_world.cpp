#include "goshawk/sensors/moving_world.hpp"

#include <algorithm>
#include <cmath>

namespace goshawk::sensors {
namespace {

// Whether a ray passes a ball before most_m.
bool passes(const Ray& ray, const Vec3& center, double radius, double most_m) {
  const Vec3 way = center - ray.origin;
  const double along = way.dot(ray.direction);
  if (along + radius < 0.0 || along - radius > most_m) return false;
  return way.squaredNorm() - along * along <= radius * radius;
}

}  // namespace

MovingWorld::MovingWorld(std::vector<movers::Mover> movers, std::int64_t start_ns)
    : movers_(std::move(movers)), start_ns_(start_ns) {
  near_.reserve(movers_.size());
}

// The movers that any of the rays may meet.
void MovingWorld::gather(std::span<const Ray> rays) const {
  near_.clear();
  std::int64_t first_ns = rays[0].time_ns, last_ns = rays[0].time_ns;
  double range_m = 0.0, spread_m = 0.0;
  for (const Ray& ray : rays) {
    first_ns = std::min(first_ns, ray.time_ns), last_ns = std::max(last_ns, ray.time_ns);
    range_m = std::max(range_m, ray.range_m);
    spread_m = std::max(spread_m, (ray.origin - rays[0].origin).norm());
  }
  const std::int64_t middle_ns = first_ns + (last_ns - first_ns) / 2;
  const double half_s = 0.5e-9 * double(last_ns - first_ns) + 1e-9;
  for (const movers::Mover& mover : movers_) {
    const movers::OrientedBox box = mover.box_at(seconds(middle_ns));
    const double radius_m = mover.reach_m() + mover.top_speed_m_s() * half_s;
    if ((box.center_map - rays[0].origin).norm() > range_m + spread_m + radius_m) continue;
    near_.push_back({&mover, box.center_map, radius_m, middle_ns, box});
  }
}

void MovingWorld::cast(std::span<const Ray> rays, std::span<Hit> hits) const {
  std::fill(hits.begin(), hits.end(), Hit{});
  if (rays.empty()) return;
  gather(rays);
  for (Near& near : near_) {
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const Ray& ray = rays[i];
      const double most_m = std::min(ray.range_m, hits[i].range_m);
      if (!passes(ray, near.center_map, near.radius_m, most_m)) continue;
      if (near.placed_ns != ray.time_ns) {
        near.placed_ns = ray.time_ns;
        near.box = near.mover->box_at(seconds(ray.time_ns));
      }
      const auto hit = near.box.cast(ray.origin, ray.direction);
      if (hit && hit->range_m <= most_m) hits[i] = {hit->range_m, hit->cosine};
    }
  }
}

}  // namespace goshawk::sensors
