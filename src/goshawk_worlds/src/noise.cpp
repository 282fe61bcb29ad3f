#include "builder.hpp"

namespace goshawk::worlds {

Result<World> make_noise(const WorldSpec& spec, const GridGeometry& geometry) {
  Builder builder(spec, geometry);
  Random random(spec.seed);
  const Index3 size = geometry.size;
  for (int z = 0; z < size.z; ++z) {
    for (int y = 0; y < size.y; ++y) {
      for (int x = 0; x < size.x; ++x) {
        if (random.chance(spec.density)) builder.occupied().set({x, y, z}, true);
      }
    }
  }
  builder.refresh();
  return World{geometry, builder.take_occupied()};
}

}  // namespace goshawk::worlds
