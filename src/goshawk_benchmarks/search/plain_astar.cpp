#include "search/plain_astar.hpp"

#include <algorithm>
#include <cmath>
#include <queue>
#include <unordered_map>
#include <unordered_set>

using goshawk::BitGrid;
using goshawk::Index3;
using goshawk::path_search::CornerRule;

namespace {

struct Hash {
  std::size_t operator()(Index3 i) const {
    return std::hash<std::int64_t>{}((std::int64_t{i.z} << 42) ^ (std::int64_t{i.y} << 21) ^ i.x);
  }
};

struct Open {
  double f;
  double g;
  Index3 at;
  bool operator<(const Open& other) const {
    return f != other.f ? f > other.f : g < other.g;  // smallest f, then largest g, on top
  }
};

double octile(Index3 a, Index3 b) {
  double d[3] = {std::abs(double(a.x - b.x)), std::abs(double(a.y - b.y)),
                 std::abs(double(a.z - b.z))};
  std::sort(d, d + 3);
  return std::sqrt(3.0) * d[0] + std::sqrt(2.0) * (d[1] - d[0]) + (d[2] - d[1]);
}

bool allowed(const BitGrid& blocked, Index3 from, Index3 to, CornerRule rule) {
  if (rule == CornerRule::squeeze) return !blocked.test(to);
  for (const int x : {from.x, to.x}) {
    for (const int y : {from.y, to.y}) {
      for (const int z : {from.z, to.z}) {
        if (blocked.test({x, y, z})) return false;
      }
    }
  }
  return true;
}

}  // namespace

double plain_astar(const BitGrid& blocked, Index3 start, Index3 goal, CornerRule rule) {
  std::priority_queue<Open> open;
  std::unordered_map<Index3, double, Hash> cost;
  std::unordered_map<Index3, Index3, Hash> parent;
  std::unordered_set<Index3, Hash> closed;
  cost[start] = 0.0;
  open.push({octile(start, goal), 0.0, start});
  while (!open.empty()) {
    const Open node = open.top();
    open.pop();
    if (node.at == goal) return node.g;
    if (!closed.insert(node.at).second) continue;
    for (int dz = -1; dz <= 1; ++dz) {
      for (int dy = -1; dy <= 1; ++dy) {
        for (int dx = -1; dx <= 1; ++dx) {
          const Index3 next = node.at + Index3{dx, dy, dz};
          if (next == node.at || !allowed(blocked, node.at, next, rule)) continue;
          const double g = node.g + std::sqrt(double(dx * dx + dy * dy + dz * dz));
          const auto held = cost.find(next);
          if (held != cost.end() && held->second <= g) continue;
          cost[next] = g;
          parent[next] = node.at;
          open.push({g + octile(next, goal), g, next});
        }
      }
    }
  }
  return -1.0;
}
