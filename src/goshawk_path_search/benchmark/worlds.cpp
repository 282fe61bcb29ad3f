#include "worlds.hpp"

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <sstream>

#include "goshawk/core/random.hpp"

namespace worlds {
namespace {

using goshawk::Random;

void fill(BitGrid& map, Index3 lo, Index3 hi, bool value) {
  const Index3 size = map.size();
  const int x0 = std::clamp(lo.x, 0, size.x), x1 = std::clamp(hi.x, x0, size.x);
  for (int z = std::max(0, lo.z); z < std::min(size.z, hi.z); ++z) {
    for (int y = std::max(0, lo.y); y < std::min(size.y, hi.y); ++y) {
      map.set_run(x0, x1, y, z, value);
    }
  }
}

double ratio_of(const BitGrid& map) {
  return double(map.count()) / double(map.voxels());
}

std::string dimensions(Index3 s) {
  return std::to_string(s.x) + "x" + std::to_string(s.y) + "x" + std::to_string(s.z);
}

// The free voxel nearest to a corner, by growing cubes.
Index3 free_near(const BitGrid& map, Index3 corner) {
  for (int r = 0; r < map.size().x; ++r) {
    for (int z = 0; z <= r; ++z) {
      for (int y = 0; y <= r; ++y) {
        for (int x = 0; x <= r; ++x) {
          const Index3 at{std::abs(corner.x - x), std::abs(corner.y - y), std::abs(corner.z - z)};
          if (std::max({x, y, z}) == r && !map.test(at)) return at;
        }
      }
    }
  }
  return corner;
}

World::Query corner_to_corner(const BitGrid& map) {
  const Index3 s = map.size();
  return {free_near(map, {0, 0, 0}), free_near(map, {s.x - 1, s.y - 1, s.z - 1})};
}

}  // namespace

World noise(Index3 size, double ratio, std::uint64_t seed) {
  Random random(seed);
  World world{"noise " + dimensions(size) + " " + std::to_string(ratio).substr(0, 4),
              BitGrid(size, true),
              {}};
  for (int z = 0; z < size.z; ++z) {
    for (int y = 0; y < size.y; ++y) {
      for (int x = 0; x < size.x; ++x) world.blocked.set({x, y, z}, random.chance(ratio));
    }
  }
  world.blocked.set({0, 0, 0}, false);
  world.blocked.set({size.x - 1, size.y - 1, size.z - 1}, false);
  world.queries = {{{0, 0, 0}, {size.x - 1, size.y - 1, size.z - 1}}};
  return world;
}

World boxes(Index3 size, double ratio, std::uint64_t seed) {
  Random random(seed);
  BitGrid map(size, true);
  const int batch = 1 + int(map.voxels() / 50000);  // boxes between looks at the ratio
  for (int tries = 0; tries < 100000; ++tries) {
    if (tries % batch == 0 && ratio_of(map) >= ratio) break;
    // Grown at once: a box whose surroundings are filled too is a box grown by one voxel.
    const bool pillar = random.chance(0.5);
    const Index3 lo{random.below(size.x), random.below(size.y), pillar ? 0 : random.below(size.z)};
    const Index3 edge{2 + random.below(9), 2 + random.below(9),
                      pillar ? size.z : 2 + random.below(9)};
    fill(map, lo - Index3{1, 1, 1}, lo + edge + Index3{1, 1, 1}, true);
  }
  World world{
      "boxes " + dimensions(size) + " " + std::to_string(ratio).substr(0, 4), std::move(map), {}};
  world.queries = {corner_to_corner(world.blocked)};
  return world;
}

World office(Index3 size, std::uint64_t seed) {
  Random random(seed);
  BitGrid map(size, true);
  constexpr int kRoom = 25;
  for (int x = kRoom; x < size.x; x += kRoom) fill(map, {x, 0, 0}, {x + 2, size.y, size.z}, true);
  for (int y = kRoom; y < size.y; y += kRoom) fill(map, {0, y, 0}, {size.x, y + 2, size.z}, true);
  for (int x = 0; x < size.x; x += kRoom) {
    for (int y = 0; y < size.y; y += kRoom) {
      const int a = 4 + random.below(14), b = 4 + random.below(14);
      fill(map, {x + kRoom, y + a, 0}, {x + kRoom + 2, y + a + 5, 10}, false);
      fill(map, {x + b, y + kRoom, 0}, {x + b + 5, y + kRoom + 2, 10}, false);
      if (random.chance(0.3)) fill(map, {x + 6, y + 6, 0}, {x + 14, y + 12, 5}, true);
    }
  }
  World world{"office " + dimensions(size), std::move(map), {}};
  world.queries = {corner_to_corner(world.blocked)};
  return world;
}

World warframe(const std::string& name, std::size_t problems) {
  const char* folder = std::getenv("GOSHAWK_DATA");
  const std::string path =
      std::string(folder != nullptr ? folder : "../shared/data") + "/warframe/" + name + ".3dmap";
  std::ifstream map_file(path), problem_file(path + ".3dscen");
  World world{"warframe " + name, {}, {}};
  std::string word;
  Index3 size, at;
  if (!(map_file >> word >> size.x >> size.y >> size.z) || !problem_file) return world;
  world.blocked = BitGrid(size, true);
  while (map_file >> at.x >> at.y >> at.z) world.blocked.set(at, true);
  std::string line;
  for (std::size_t n = 0; n < 2; ++n) std::getline(problem_file, line);  // version, map name
  while (world.queries.size() < problems && std::getline(problem_file, line)) {
    World::Query q;
    std::istringstream in(line);
    if (in >> q.start.x >> q.start.y >> q.start.z >> q.goal.x >> q.goal.y >> q.goal.z) {
      world.queries.push_back(q);
    }
  }
  return world;
}

}  // namespace worlds
