#pragma once

#include <cstdint>
#include <limits>
#include <span>

#include "goshawk/core/vector.hpp"

namespace goshawk::sensors {

struct Ray {
  Vec3 origin = Vec3::Zero();      // [m] frame of the world
  Vec3 direction = Vec3::UnitX();  // of length 1
  double range_m = 0.0;            // nothing beyond is looked for
  std::int64_t time_ns = 0;        // when it is fired; worlds that stand still need no time
};

/// Where a ray meets the first surface.
struct Hit {
  double range_m = std::numeric_limits<double>::infinity();  // infinite: it meets nothing
  double cosine = 0.0;  // of the angle between the ray and the surface's normal, 0 to 1

  bool any() const { return range_m < std::numeric_limits<double>::infinity(); }
};

/// The truth that sensors see: voxels, solids, a physics engine's model, things that move.
class World {
 public:
  virtual ~World() = default;

  /// Casts many rays at once. A ray that begins inside of an obstacle meets it at range 0.
  /// @param hits one a ray, overwritten @pre as many hits as rays
  virtual void cast(std::span<const Ray> rays, std::span<Hit> hits) const = 0;

  /// @return whether the point lies inside of an obstacle
  virtual bool contains(const Vec3& point) const = 0;
};

}  // namespace goshawk::sensors
