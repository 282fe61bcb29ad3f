#include "goshawk/path_search/path_reuse.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "goshawk/path_search/move_cost.hpp"

namespace goshawk::path_search {
namespace {

// A move past a voxel that became free begins and ends within a triagonal move of it.
constexpr Cost kMovePast = 2 * kMoveCost[3];

class ReusingPlanner final : public GridPlanner {
 public:
  ReusingPlanner(std::unique_ptr<GridPlanner> planner, CornerRule rule)
      : planner_(std::move(planner)), rule_(rule) {}

  std::string_view name() const override { return planner_->name(); }
  using GridPlanner::set_map;
  void set_map(const BitGrid& blocked, const BitGrid* known) override {
    planner_->set_map(blocked, known);
    map_ = blocked;
  }
  using GridPlanner::search;
  Status search(const GridQuery& query, VoxelPath& path) override;

 private:
  bool reuse(const GridQuery& query, VoxelPath& path) const;
  bool move_is_allowed(Index3 from, Index3 to) const;
  bool could_shorten(Index3 start, Index3 goal, Cost cost) const;

  std::unique_ptr<GridPlanner> planner_;
  CornerRule rule_;
  BitGrid map_;
  BitGrid map_of_path_;        // on which the last path was found
  std::vector<Index3> cells_;  // of the last path; empty if there is none
};

Status ReusingPlanner::search(const GridQuery& query, VoxelPath& path) {
  if (query.goals.size() == 1 && reuse(query, path)) return success();
  Status status = planner_->search(query, path);
  cells_.clear();
  if (!status || query.goals.size() != 1) return status;
  cells_ = path.cells;
  map_of_path_ = map_;
  return status;
}

bool ReusingPlanner::reuse(const GridQuery& query, VoxelPath& path) const {
  const Index3 start = query.start.cell, goal = query.goals.front().cell;
  if (cells_.empty() || !(cells_.back() == goal) || !(map_.size() == map_of_path_.size())) {
    return false;
  }
  const auto first = std::ranges::find(cells_, start);
  if (first == cells_.end() || map_.get(start)) return false;
  std::array<std::int64_t, 4> moves{};
  for (auto at = first; at + 1 != cells_.end(); ++at) {
    if (!move_is_allowed(*at, *(at + 1))) return false;
    ++moves[std::size_t(axes_changed(direction_of(*(at + 1) - *at)))];
  }
  const Cost cost = moves[1] * kMoveCost[1] + moves[2] * kMoveCost[2] + moves[3] * kMoveCost[3];
  if (could_shorten(start, goal, cost)) return false;
  path.clear();
  path.cells.assign(first, cells_.end());
  path.cost_voxels =
      double(moves[1]) + double(moves[2]) * std::sqrt(2.0) + double(moves[3]) * std::sqrt(3.0);
  return true;
}

bool ReusingPlanner::move_is_allowed(Index3 from, Index3 to) const {
  if (rule_ == CornerRule::squeeze) return !map_.get(to);
  for (const int z : {from.z, to.z}) {
    for (const int y : {from.y, to.y}) {
      for (const int x : {from.x, to.x}) {
        if (map_.get({x, y, z})) return false;
      }
    }
  }
  return true;
}

// Is a voxel free that was not, and so near to both ends that a path over it could be shorter?
bool ReusingPlanner::could_shorten(Index3 start, Index3 goal, Cost cost) const {
  bool could = false;
  const auto look = [&](int w, int y, int z) {
    auto freed = map_of_path_.row(y, z)[w] & ~map_.row(y, z)[w];
    for (; freed != 0 && !could; freed &= freed - 1) {
      const Index3 at{64 * w + std::countr_zero(freed), y, z};
      const OctileHeuristic distance;
      could = at.x < map_.size().x && distance(start, at) + distance(at, goal) - kMovePast < cost;
    }
  };
  for_changed_chunks(map_of_path_, map_, [&](BitGrid::Rows rows) {
    for (int z = rows.z0; z < rows.z1 && !could; ++z) {
      for (int y = rows.y0; y < rows.y1 && !could; ++y) {
        for (int w = 0; w < int(map_.words_per_row()) && !could; ++w) look(w, y, z);
      }
    }
  });
  return could;
}

}  // namespace

std::unique_ptr<GridPlanner> make_reusing(std::unique_ptr<GridPlanner> planner, CornerRule rule) {
  return std::make_unique<ReusingPlanner>(std::move(planner), rule);
}

}  // namespace goshawk::path_search
