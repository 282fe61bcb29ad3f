#include "growing_world.hpp"

#include "goshawk/core/inflation.hpp"

namespace goshawk::goals {

GrowingWorld::GrowingWorld(const worlds::WorldSpec& spec) {
  auto made = worlds::make_world(spec).value();
  geometry_ = made.geometry;
  raw_ = std::move(made.occupied);
  grow();
}

void GrowingWorld::grow() {
  const double radius_m = kBody_m + kTrackingMargin_m;
  auto grown = inflate(raw_, radius_m, geometry_.resolution_m).value();
  map_ = std::make_shared<const VoxelGrid>(VoxelGrid{.geometry = geometry_,
                                                     .grown = std::move(grown),
                                                     .known = {},
                                                     .raw = raw_,
                                                     .version = ++version_,
                                                     .inflation_m = radius_m});
}

void GrowingWorld::add(Index3 voxel) {
  raw_.set(voxel, true);
  grow();
}

Vec3 GrowingWorld::free_place(Random& random) const {
  for (;;) {
    const Index3 voxel{random.below(geometry_.size.x), random.below(geometry_.size.y),
                       random.below(geometry_.size.z)};
    if (!map_->grown.get(voxel)) return geometry_.center(voxel);
  }
}

}  // namespace goshawk::goals
