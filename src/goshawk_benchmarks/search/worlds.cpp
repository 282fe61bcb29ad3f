#include "search/worlds.hpp"

#include <algorithm>
#include <cstdlib>
#include <functional>
#include <stdexcept>

#include "goshawk/core/inflation.hpp"
#include "goshawk/core/random.hpp"
#include "goshawk/map_server/map_file.hpp"
#include "goshawk/map_server/voxel_map.hpp"
#include "goshawk/path_search/grid_search.hpp"
#include "goshawk/path_search/move_cost.hpp"
#include "goshawk/worlds/world.hpp"
#include "search/warframe_files.hpp"

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

World forest(Index3 size, double ratio, std::uint64_t seed) {
  goshawk::worlds::WorldSpec spec;
  spec.kind = "forest";
  spec.size_m = 0.2 * goshawk::Vec3(size.x, size.y, size.z);
  spec.density = ratio;
  spec.seed = seed;
  const auto made = goshawk::worlds::make_world(spec);
  if (!made) throw std::runtime_error(made.error().message);
  World world{"forest " + dimensions(size), *goshawk::inflate(made->occupied, 0.2, 0.2), {}};
  world.queries = {corner_to_corner(world.blocked)};
  return world;
}

std::string data_folder() {
  const char* folder = std::getenv("GOSHAWK_DATA");
  return folder != nullptr ? folder : "../shared/data";
}

World octomap(const std::string& name, std::size_t queries) {
  using namespace goshawk::map_server;
  World world{name, {}, {}};
  const auto source = load_map(data_folder() + "/octomap/" + name);
  if (!source) return world;
  const auto raw = voxelize(*source);
  if (!raw) return world;
  const auto grid =
      make_voxel_grid(*raw, {.unknown = UnknownPolicy::blocked, .inflation_m = 0.2}, 1);
  if (!grid) return world;
  world.blocked = grid->grown;
  const auto planner = goshawk::path_search::make_grid_search(
      goshawk::path_search::Planner::jastar, goshawk::path_search::CornerRule::no_squeeze);
  planner->set_map(world.blocked);
  Random random(1);
  const Index3 s = world.blocked.size();
  const auto any = [&] { return Index3{random.below(s.x), random.below(s.y), random.below(s.z)}; };
  for (int tries = 0; tries < 1000000 && world.queries.size() < queries; ++tries) {
    const World::Query q{any(), any()};
    if (world.blocked.get(q.start) || world.blocked.get(q.goal)) continue;
    if (planner->search(q.start, q.goal).ok()) world.queries.push_back(q);
  }
  return world;
}

World warframe(const std::string& name, std::size_t problems) {
  const std::string path = data_folder() + "/warframe/" + name + ".3dmap";
  World world{"warframe " + name, {}, {}};
  auto map = read_voxel_map(path);
  auto all = read_scenario(path + ".3dscen");
  if (!map || !all) return world;
  world.blocked = *std::move(map);
  const std::size_t stride = std::max<std::size_t>(1, all->size() / problems);
  for (std::size_t k = 0; k < all->size(); k += stride) {
    world.queries.push_back({(*all)[k].start, (*all)[k].goal});
  }
  return world;
}

World warframe_hard(const std::string& name, std::size_t problems) {
  const std::string path = data_folder() + "/warframe/" + name + ".3dmap";
  World world{"warframe " + name + ", hard", {}, {}};
  auto map = read_voxel_map(path);
  auto all = read_scenario(path + ".3dscen");
  if (!map || !all) return world;
  world.blocked = *std::move(map);
  const auto detour = [](const Problem& p) {
    const auto empty = goshawk::path_search::OctileHeuristic{}(p.start, p.goal);
    return p.length_voxels - double(empty) / double(goshawk::path_search::kUnit);
  };
  std::ranges::stable_sort(*all, std::greater<>{}, detour);
  for (std::size_t k = 0; k < std::min(problems, all->size()); ++k) {
    world.queries.push_back({(*all)[k].start, (*all)[k].goal});
  }
  return world;
}

World walled(World world) {
  world.cut_off = [](BitGrid& map) {
    const Index3 size = map.size();
    fill(map, {size.x / 2, 0, 0}, {size.x / 2 + 2, size.y, size.z}, true);
  };
  world.cut_off(world.blocked);
  return world;
}

World with_closed_room(World world) {
  world.cut_off = [](BitGrid& map) {
    const Index3 size = map.size();
    const Index3 lo{size.x / 2 - 50, size.y / 2 - 30, size.z / 2 - 15};
    const Index3 hi{lo.x + 100, lo.y + 60, lo.z + 30};
    for (const int x : {lo.x, hi.x - 1}) fill(map, {x, lo.y, lo.z}, {x + 1, hi.y, hi.z}, true);
    for (const int y : {lo.y, hi.y - 1}) fill(map, {lo.x, y, lo.z}, {hi.x, y + 1, hi.z}, true);
    for (const int z : {lo.z, hi.z - 1}) fill(map, {lo.x, lo.y, z}, {hi.x, hi.y, z + 1}, true);
  };
  world.cut_off(world.blocked);
  const Index3 size = world.blocked.size();
  Index3 goal{size.x / 2, size.y / 2, size.z / 2};
  while (world.blocked.get(goal)) ++goal.x;
  world.queries.front().goal = goal;
  return world;
}

}  // namespace worlds
