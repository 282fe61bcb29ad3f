#include "goshawk/path_search/reachable.hpp"

#include <limits>
#include <tuple>

#include "goshawk/path_search/move_cost.hpp"

namespace goshawk::path_search {
namespace {

struct Nearest {
  double squared = std::numeric_limits<double>::infinity();
  Index3 at;

  void offer(Index3 i, std::span<const End> goals) {
    for (const End& goal : goals) {
      const double d = (Vec3(i.x + 0.5, i.y + 0.5, i.z + 0.5) - goal.at_grid).squaredNorm();
      if (std::tuple(d, i.z, i.y, i.x) < std::tuple(squared, at.z, at.y, at.x)) {
        squared = d;
        at = i;
      }
    }
  }
};

}  // namespace

// A flood. Under no_squeeze every move splits into straight ones, so those suffice.
Result<Index3> nearest_reachable(const BitGrid& blocked, CornerRule rule, const GridQuery& query) {
  BitGrid seen(blocked.size(), true);
  std::vector<Index3> front = {query.start.cell};
  seen.set(query.start.cell, true);
  Nearest nearest;
  for (std::size_t visited = 1; !front.empty(); ++visited) {
    const Index3 at = front.back();
    front.pop_back();
    nearest.offer(at, query.goals);
    if (visited % 4096 == 0) {
      if (auto status = query.stop.check(); !status) return status.error();
    }
    for (int d = 0; d < kDirections; ++d) {
      if (d == kNoDirection ||
          (rule == CornerRule::no_squeeze && kMoves[std::size_t(d)].axis < 0)) {
        continue;
      }
      const Index3 next = at + kMoves[std::size_t(d)].step;
      if (seen.test(next) || blocked.test(next)) continue;
      seen.set(next, true);
      front.push_back(next);
    }
  }
  return nearest.at;
}

}  // namespace goshawk::path_search
