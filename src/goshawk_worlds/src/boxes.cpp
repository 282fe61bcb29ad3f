#include <algorithm>

#include "builder.hpp"

namespace goshawk::worlds {

Result<World> make_boxes(const WorldSpec& spec, const GridGeometry& geometry) {
  Builder builder(spec, geometry);
  Random random(spec.seed);
  const Index3 world = geometry.size;

  // Every third shape is a pillar: boxes alone leave a way over the top nearly everywhere.
  const auto draw = [&](double scale) -> Shape {
    const auto side = [&](double lo_m, double hi_m) {
      return builder.voxels_of(scale * random.uniform(lo_m, hi_m));
    };
    const bool pillar = random.below(3) == 0 && scale > 0.5;
    Index3 size{};
    if (pillar) {
      size = {side(0.2, 0.6), side(0.2, 0.6), world.z};
    } else {
      size = {side(0.3, 1.2), side(0.3, 1.2), side(0.3, 1.2)};
    }
    size = {std::min(size.x, world.x), std::min(size.y, world.y), std::min(size.z, world.z)};
    const auto place = [&](int room, int length) { return random.below(room - length + 1); };
    const Index3 lower{place(world.x, size.x), place(world.y, size.y), place(world.z, size.z)};
    return solid_box(lower, size);
  };

  builder.refresh();
  if (auto filled = fill_to_density(builder, spec.density, draw); !filled) return filled.error();
  return World{geometry, builder.take_occupied()};
}

}  // namespace goshawk::worlds
