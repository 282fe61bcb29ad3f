#include "goshawk/sensors/joined_world.hpp"

#include <algorithm>

namespace goshawk::sensors {

void JoinedWorld::cast(std::span<const Ray> rays, std::span<Hit> hits) const {
  std::fill(hits.begin(), hits.end(), Hit{});
  others_.resize(rays.size());
  for (const auto& world : worlds_) {
    world->cast(rays, others_);
    for (std::size_t i = 0; i < rays.size(); ++i) {
      if (others_[i].range_m < hits[i].range_m) hits[i] = others_[i];
    }
  }
}

bool JoinedWorld::contains(const Vec3& point) const {
  return std::any_of(worlds_.begin(), worlds_.end(),
                     [&](const auto& world) { return world->contains(point); });
}

}  // namespace goshawk::sensors
