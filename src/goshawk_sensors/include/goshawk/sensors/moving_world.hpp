#pragma once

#include <cstdint>
#include <vector>

#include "goshawk/movers/mover.hpp"
#include "goshawk/sensors/world.hpp"

namespace goshawk::sensors {

/// What moves: each ray meets it where it is when the ray is fired. Not to be used in two threads
/// at once.
class MovingWorld : public World {
 public:
  /// @param start_ns stamp at which the movers' time is 0
  MovingWorld(std::vector<movers::Mover> movers, std::int64_t start_ns);

  void cast(std::span<const Ray> rays, std::span<Hit> hits) const override;
  /// Never: what moves through a sensor does not end its scan. Rays that begin inside of a mover
  /// meet it at range 0, which no sensor measures.
  bool contains(const Vec3&) const override { return false; }

 private:
  /// A mover for a while: all of it lies in the ball all the time.
  struct Near {
    const movers::Mover* mover;
    Vec3 center_map;
    double radius_m;
    std::int64_t placed_ns;
    movers::OrientedBox box;  // at placed_ns
  };

  void gather(std::span<const Ray> rays) const;
  double seconds(std::int64_t time_ns) const { return 1e-9 * double(time_ns - start_ns_); }

  std::vector<movers::Mover> movers_;
  std::int64_t start_ns_;
  mutable std::vector<Near> near_;
};

}  // namespace goshawk::sensors
