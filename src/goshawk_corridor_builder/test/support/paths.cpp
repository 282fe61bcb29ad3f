#include "paths.hpp"

#include <algorithm>
#include <limits>
#include <queue>

#include "goshawk/core/line_of_sight.hpp"
#include "goshawk/core/random.hpp"

namespace goshawk::corridor_builder::test_support {
namespace {

struct Open {
  double f;
  std::size_t id;
  bool operator<(const Open& other) const { return f > other.f; }
};

std::vector<Vec3> prune(const VoxelGrid& grid, const std::vector<Vec3>& points) {
  std::vector<Vec3> kept{points.front()};
  for (std::size_t i = 0; i + 1 < points.size();) {
    std::size_t far = points.size() - 1;
    while (far > i + 1 && !line_is_free(grid, points[i], points[far])) --far;
    kept.push_back(points[far]);
    i = far;
  }
  return kept;
}

}  // namespace

std::vector<Vec3> pruned_path(const VoxelGrid& grid, Index3 start, Index3 goal) {
  const Index3 n = grid.geometry.size;
  auto id_of = [&](Index3 i) {
    return (std::size_t(i.z) * std::size_t(n.y) + std::size_t(i.y)) * std::size_t(n.x) +
           std::size_t(i.x);
  };
  auto index_of = [&](std::size_t id) {
    return Index3{int(id % std::size_t(n.x)), int(id / std::size_t(n.x) % std::size_t(n.y)),
                  int(id / std::size_t(n.x) / std::size_t(n.y))};
  };
  auto center = [](Index3 i) { return Vec3(i.x + 0.5, i.y + 0.5, i.z + 0.5); };
  std::vector<double> cost(std::size_t(grid.occupied.voxels()),
                           std::numeric_limits<double>::infinity());
  std::vector<std::size_t> parent(cost.size());
  std::priority_queue<Open> open;
  cost[id_of(start)] = 0.0;
  parent[id_of(start)] = id_of(start);
  open.push({0.0, id_of(start)});
  while (!open.empty()) {
    const std::size_t id = open.top().id;
    open.pop();
    const Index3 i = index_of(id);
    if (i == goal) break;
    for (int k = 0; k < 27; ++k) {
      const Index3 j = i + Index3{k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1};
      if (j == i || grid.occupied.test(j)) continue;
      const double g = cost[id] + (center(j) - center(i)).norm();
      if (g >= cost[id_of(j)] - 1e-12) continue;
      if (!line_is_free(grid.occupied, center(i), center(j))) continue;
      cost[id_of(j)] = g;
      parent[id_of(j)] = id;
      open.push({g + (center(goal) - center(j)).norm(), id_of(j)});
    }
  }
  if (!(cost[id_of(goal)] < std::numeric_limits<double>::infinity())) return {};
  std::vector<Vec3> points;
  for (std::size_t id = id_of(goal);; id = parent[id]) {
    points.push_back(grid.geometry.center(index_of(id)));
    if (id == id_of(start)) break;
  }
  std::reverse(points.begin(), points.end());
  if (points.size() < 2) return {};
  return prune(grid, points);
}

std::vector<Vec3> random_pruned_path(const VoxelGrid& grid, std::uint64_t seed) {
  Random random(seed);
  const Index3 n = grid.geometry.size;
  Index3 ends[2];
  for (Index3& end : ends) {
    int tries = 0;
    do {
      end = {random.below(n.x), random.below(n.y), random.below(n.z)};
    } while (grid.occupied.get(end) && ++tries < 1000);
    if (tries >= 1000) return {};
  }
  return pruned_path(grid, ends[0], ends[1]);
}

}  // namespace goshawk::corridor_builder::test_support
