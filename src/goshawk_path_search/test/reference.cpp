#include "reference.hpp"

#include <cmath>
#include <limits>
#include <queue>

namespace reference {
namespace {

std::size_t flat(Index3 i, Index3 size) {
  return (std::size_t(i.z) * std::size_t(size.y) + std::size_t(i.y)) * std::size_t(size.x) +
         std::size_t(i.x);
}

double move_length(Index3 a, Index3 b) {
  return std::hypot(double(a.x - b.x), double(a.y - b.y), double(a.z - b.z));
}

}  // namespace

bool move_is_allowed(const BitGrid& blocked, Index3 from, Index3 to, bool squeeze) {
  if (squeeze) return !blocked.test(to);
  for (const int x : {from.x, to.x}) {
    for (const int y : {from.y, to.y}) {
      for (const int z : {from.z, to.z}) {
        if (blocked.test({x, y, z})) return false;
      }
    }
  }
  return true;
}

std::vector<double> distances(const BitGrid& blocked, Index3 start, bool squeeze) {
  return distances(blocked, start, squeeze, move_length);
}

std::vector<double> distances(const BitGrid& blocked, Index3 start, bool squeeze,
                              const MoveCostOf& cost) {
  const Index3 size = blocked.size();
  std::vector<double> best(std::size_t(blocked.voxels()), std::numeric_limits<double>::infinity());
  struct Open {
    double length;
    Index3 at;
    bool operator<(const Open& other) const { return length > other.length; }
  };
  std::priority_queue<Open> open;
  best[flat(start, size)] = 0.0;
  open.push({0.0, start});
  while (!open.empty()) {
    const Open node = open.top();
    open.pop();
    if (node.length > best[flat(node.at, size)]) continue;
    for (int dz = -1; dz <= 1; ++dz) {
      for (int dy = -1; dy <= 1; ++dy) {
        for (int dx = -1; dx <= 1; ++dx) {
          const Index3 next = node.at + Index3{dx, dy, dz};
          if (next == node.at || !move_is_allowed(blocked, node.at, next, squeeze)) continue;
          const double length = node.length + cost(node.at, next);
          if (length < best[flat(next, size)]) {
            best[flat(next, size)] = length;
            open.push({length, next});
          }
        }
      }
    }
  }
  return best;
}

double distance_to(const std::vector<double>& distances, Index3 size, Index3 goal) {
  return distances[flat(goal, size)];
}

std::string fault_of_path(const BitGrid& blocked, const std::vector<Index3>& cells, Index3 start,
                          Index3 goal, bool squeeze, double length) {
  return fault_of_path(blocked, cells, start, goal, squeeze, length, move_length);
}

std::string fault_of_path(const BitGrid& blocked, const std::vector<Index3>& cells, Index3 start,
                          Index3 goal, bool squeeze, double length, const MoveCostOf& cost) {
  if (cells.empty()) return "no cells";
  if (!(cells.front() == start) || !(cells.back() == goal)) return "wrong ends";
  double sum = 0.0;
  for (std::size_t i = 1; i < cells.size(); ++i) {
    const Index3 d = cells[i] - cells[i - 1];
    if (std::abs(d.x) > 1 || std::abs(d.y) > 1 || std::abs(d.z) > 1 || d == Index3{}) {
      return "not a move at " + std::to_string(i);
    }
    if (!move_is_allowed(blocked, cells[i - 1], cells[i], squeeze)) {
      return "a move that the rule forbids at " + std::to_string(i);
    }
    sum += cost(cells[i - 1], cells[i]);
  }
  if (std::abs(sum - length) > 1e-9 * (1.0 + sum)) return "cost is not the length of the cells";
  return "";
}

BitGrid noise_map(Index3 size, double ratio, Random& random) {
  BitGrid map(size, true);
  for (int z = 0; z < size.z; ++z) {
    for (int y = 0; y < size.y; ++y) {
      for (int x = 0; x < size.x; ++x) map.set({x, y, z}, random.chance(ratio));
    }
  }
  return map;
}

BitGrid box_map(Index3 size, double ratio, Random& random) {
  BitGrid map(size, true);
  for (int tries = 0; tries < 200 && double(map.count()) < ratio * double(map.voxels()); ++tries) {
    const bool pillar = random.chance(0.5);
    const Index3 lo{random.below(size.x), random.below(size.y), pillar ? 0 : random.below(size.z)};
    const Index3 edge{1 + random.below(5), 1 + random.below(5),
                      pillar ? size.z : 1 + random.below(5)};
    for (int z = lo.z; z < std::min(size.z, lo.z + edge.z); ++z) {
      for (int y = lo.y; y < std::min(size.y, lo.y + edge.y); ++y) {
        map.set_run(lo.x, std::min(size.x, lo.x + edge.x), y, z, true);
      }
    }
  }
  return map;
}

Index3 odd_size(Random& random) {
  const auto small = [&] { return 1 + random.below(10); };
  switch (random.below(8)) {
    case 0:
      return {small(), small(), 1};
    case 1:
      return {1, small(), small()};
    case 2:
      return {1 + random.below(40), 1, 1 + random.below(20)};
    case 3:
      return {61 + random.below(8), 1 + random.below(4), 1 + random.below(4)};
    case 4:
      return {1 + random.below(4), 61 + random.below(8), 1 + random.below(4)};
    case 5:
      return {1 + random.below(4), 1 + random.below(4), 125 + random.below(8)};
    default:
      return {small(), small(), small()};
  }
}

BitGrid any_map(Random& random) {
  const Index3 size = odd_size(random);
  const double ratio = random.uniform(0.02, 0.5);
  return random.chance(0.6) ? noise_map(size, ratio, random) : box_map(size, ratio, random);
}

Index3 free_voxel(const BitGrid& blocked, Random& random) {
  const Index3 size = blocked.size();
  Index3 at;
  for (int tries = 0; tries < 200; ++tries) {
    at = {random.below(size.x), random.below(size.y), random.below(size.z)};
    if (!blocked.get(at)) break;
  }
  return at;
}

std::shared_ptr<goshawk::VoxelGrid> grid_of(BitGrid blocked) {
  auto grid = std::make_shared<goshawk::VoxelGrid>();
  grid->geometry = {goshawk::Vec3(-1.0, 2.0, 0.5), 0.2, blocked.size()};
  grid->grown = std::move(blocked);
  return grid;
}

}  // namespace reference
