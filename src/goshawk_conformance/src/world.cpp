#include "world.hpp"

namespace goshawk::conformance {
namespace {

constexpr Index3 kSize{40, 40, 15};
constexpr int kRoom = 7;  // [voxel] edge of the closed room, walls included

void fill(BitGrid& grid, Index3 from, Index3 to, bool value) {
  for (int z = from.z; z < to.z; ++z) {
    for (int y = from.y; y < to.y; ++y) grid.set_run(from.x, to.x, y, z, value);
  }
}

bool is_roomy(const BitGrid& grid, Index3 i) {
  for (int n = 0; n < 27; ++n) {
    if (grid.test({i.x + n % 3 - 1, i.y + n / 3 % 3 - 1, i.z + n / 9 - 1})) return false;
  }
  return true;
}

}  // namespace

World make_world(std::uint64_t seed) {
  Random random(seed);
  auto grid = std::make_shared<VoxelGrid>();
  grid->geometry = {.origin_map = Vec3(-1.0, -2.0, 0.0), .resolution_m = 0.2, .size = kSize};
  grid->grown = BitGrid(kSize, true);
  grid->version = 7;
  grid->inflation_m = 0.2;
  for (int k = 0; k < 25; ++k) {
    const Index3 from{random.below(kSize.x - 5), random.below(kSize.y - 5), random.below(kSize.z)};
    const Index3 to{from.x + 2 + random.below(4), from.y + 2 + random.below(4),
                    std::min(kSize.z, from.z + 3 + random.below(10))};
    fill(grid->grown, from, to, true);
  }
  fill(grid->grown, {0, 0, 0}, {kRoom, kRoom, kRoom}, true);
  fill(grid->grown, {1, 1, 1}, {kRoom - 1, kRoom - 1, kRoom - 1}, false);
  World world;
  world.in_room_map = grid->geometry.center({3, 3, 3});
  world.in_obstacle_map = grid->geometry.center({0, 3, 3});
  world.outside_map = grid->geometry.upper_corner_map() + Vec3(5.0, 5.0, 5.0);
  world.grid = std::move(grid);
  return world;
}

Vec3 free_point(const World& world, Random& random) {
  const auto& grid = *world.grid;
  for (;;) {
    const Index3 i{random.below(kSize.x), random.below(kSize.y), random.below(kSize.z)};
    const bool in_room = i.x < kRoom && i.y < kRoom && i.z < kRoom;
    if (!in_room && is_roomy(grid.grown, i)) return grid.geometry.center(i);
  }
}

}  // namespace goshawk::conformance
