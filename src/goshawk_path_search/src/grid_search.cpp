#include "goshawk/path_search/grid_search.hpp"

#include <stdexcept>

#include "best_first_search.hpp"
#include "expansion.hpp"

namespace goshawk::path_search {
namespace {

using best_first::GridSearch;

// From so many voxels on, a plain table's first touch of a page costs more than tiles do.
constexpr std::int64_t kTilesFromVoxels = std::int64_t{1} << 20;

/// JA* with the labels that suit the size of the map.
class JaStar final : public GridPlanner {
 public:
  explicit JaStar(CornerRule rule) : rule_(rule), planner_(make_jastar(rule, false)) {}

  std::string_view name() const override { return planner_->name(); }
  using GridPlanner::set_map;
  void set_map(const BitGrid& blocked, const BitGrid* known) override {
    const bool tiled = blocked.voxels() >= kTilesFromVoxels;
    if (tiled != tiled_) planner_ = make_jastar(rule_, tiled);
    tiled_ = tiled;
    planner_->set_map(blocked, known);
  }
  using GridPlanner::search;
  Status search(const GridQuery& query, VoxelPath& path) override {
    return planner_->search(query, path);
  }

 private:
  CornerRule rule_;
  std::unique_ptr<GridPlanner> planner_;
  bool tiled_ = false;
};

}  // namespace

std::unique_ptr<GridPlanner> make_jastar(CornerRule rule, bool tiled) {
  if (tiled)
    return std::make_unique<GridSearch<OctileHeuristic, true, TiledLabels>>("jastar", rule);
  return std::make_unique<GridSearch<OctileHeuristic, true, LabelTable>>("jastar", rule);
}

std::unique_ptr<GridPlanner> make_grid_search(Planner planner, CornerRule rule) {
  switch (planner) {
    case Planner::jastar:
      return std::make_unique<JaStar>(rule);
    case Planner::astar:
      return std::make_unique<GridSearch<OctileHeuristic, false, LabelTable>>("astar", rule);
    case Planner::astar_euclidean:
      return std::make_unique<GridSearch<EuclideanHeuristic, false, LabelTable>>("astar_euclidean",
                                                                                 rule);
    case Planner::astar_manhattan:
      return std::make_unique<GridSearch<ManhattanHeuristic, false, LabelTable>>("astar_manhattan",
                                                                                 rule);
    case Planner::dijkstra:
      return std::make_unique<GridSearch<ZeroHeuristic, false, LabelTable>>("dijkstra", rule);
    default:
      throw std::invalid_argument("make_grid_search() of a planner that samples");
  }
}

}  // namespace goshawk::path_search
