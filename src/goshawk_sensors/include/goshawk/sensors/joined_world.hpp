#pragma once

#include <memory>
#include <vector>

#include "goshawk/sensors/world.hpp"

namespace goshawk::sensors {

/// Several worlds in one place: a ray meets what comes first in any of them. Not to be used in two
/// threads at once.
class JoinedWorld : public World {
 public:
  explicit JoinedWorld(std::vector<std::shared_ptr<const World>> worlds)
      : worlds_(std::move(worlds)) {}

  void cast(std::span<const Ray> rays, std::span<Hit> hits) const override;
  bool contains(const Vec3& point) const override;

 private:
  std::vector<std::shared_ptr<const World>> worlds_;
  mutable std::vector<Hit> others_;
};

}  // namespace goshawk::sensors
