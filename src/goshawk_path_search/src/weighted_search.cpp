#include "goshawk/path_search/weighted_search.hpp"

#include <bit>
#include <cmath>
#include <limits>

#include "goshawk/path_search/bucket_queue.hpp"
#include "goshawk/path_search/move_cost.hpp"
#include "goshawk/path_search/move_rules.hpp"
#include "goshawk/path_search/obstacle_bits.hpp"

namespace goshawk::path_search {
namespace {

using Node = ObstacleBits::Node;

constexpr int kExpansionsBetweenLooks = 1024;
const std::array<double, 4> kLength = {0.0, 1.0, std::sqrt(2.0), std::sqrt(3.0)};
constexpr double kUnreached = std::numeric_limits<double>::infinity();

/// Costs in voxel edges. The queue's integer keys only order the work: a node is expanded again
/// when it improves, and the search ends when no bucket below the best goal is left.
class WeightedSearch final : public GridPlanner {
 public:
  WeightedSearch(std::string_view name, bool use_heuristic, CornerRule rule, const Weights& weights)
      : name_(name),
        use_heuristic_(use_heuristic),
        rule_(rule),
        weights_(weights),
        field_(weights) {}

  using GridPlanner::search;
  using GridPlanner::set_map;
  std::string_view name() const override { return name_; }
  void set_map(const BitGrid& blocked, const BitGrid* known) override;
  Status search(const GridQuery& query, VoxelPath& path) override;

 private:
  struct Label {
    double cost = 0.0;
    std::uint32_t query = 0;
    std::uint8_t direction = 0;
    bool expanded = false;
  };

  Status run(const GridQuery& query);
  void expand(Node node);
  void reach(Node node, Index3 at, double cost, int direction);
  double estimate(Index3 at) const;
  void trace(VoxelPath& path) const;

  std::string_view name_;
  bool use_heuristic_;
  CornerRule rule_;
  Weights weights_;
  CostField field_;
  Error map_error_{ErrorCode::no_map, "no map yet: wait for one, or load one, before planning"};
  ObstacleBits bits_;
  std::vector<Label> labels_;
  BucketQueue queue_;

  // Of the query at work.
  std::uint32_t query_ = 0;
  std::span<const End> goals_;
  Index3 start_;
  double bound_ = kUnreached;
  std::size_t goal_ = 0;
  Counters counters_;
};

void WeightedSearch::set_map(const BitGrid& blocked, const BitGrid* known) {
  const std::int64_t nodes = blocked.empty() ? 0 : ObstacleBits::nodes_for(blocked.size());
  if (nodes == 0 || nodes > std::int64_t{1} << 31) {
    labels_.clear();
    map_error_ = blocked.empty()
                     ? fail(ErrorCode::no_map, "the map is empty: load one with a voxel or more")
                     : fail(ErrorCode::map_too_large,
                            "a map of " + to_text(blocked.size()) +
                                " voxels is too large for a weighted search (17 bytes a voxel, at "
                                "most 2^31 voxels): use a coarser resolution or a smaller box");
    return;
  }
  if (!(bits_.size() == blocked.size()) || labels_.empty()) {
    labels_.assign(std::size_t(nodes), {});
    query_ = 0;
  }
  bits_.assign(blocked);
  field_.assign(blocked, known);
}

Status WeightedSearch::search(const GridQuery& query, VoxelPath& path) {
  path.clear();
  if (labels_.empty()) return map_error_;
  auto status =
      check_ends(query, bits_.size(), [this](Index3 i) { return bits_.blocked(bits_.node(i)); });
  if (!status) return status;
  if (query_ == std::numeric_limits<std::uint32_t>::max()) {
    labels_.assign(labels_.size(), {});
    query_ = 0;
  }
  ++query_;
  status = run(query);
  path.counters = counters_;
  if (!status) return status;
  if (bound_ == kUnreached) return no_way(query);
  trace(path);
  return success();
}

Status WeightedSearch::run(const GridQuery& query) {
  goals_ = query.goals;
  start_ = query.start.cell;
  bound_ = kUnreached;
  counters_ = {};
  queue_.clear(0);
  reach(bits_.node(start_), start_, 0.0, kNoDirection);
  int left = kExpansionsBetweenLooks;
  while (queue_.advance()) {
    if (double(queue_.lowest_key()) >= bound_ * double(kUnit)) break;
    const Node node = queue_.pop().node;
    if (labels_[node].expanded) continue;
    if (--left == 0) {
      if (auto status = query.stop.check(); !status) return status;
      left = kExpansionsBetweenLooks;
    }
    expand(node);
  }
  return success();
}

void WeightedSearch::expand(Node node) {
  labels_[node].expanded = true;
  ++counters_.expanded;
  const double cost = labels_[node].cost;
  const Index3 at = bits_.index(node);
  for (BlockMask moves = MoveRules::allowed(rule_, bits_.block(node)); moves != 0;
       moves &= moves - 1) {
    const int d = std::countr_zero(moves);
    const Index3 step = kMoves[std::size_t(d)].step;
    const Index3 next = at + step;
    const double length = kLength[std::size_t(axes_changed(d))];
    const double climb = step.z > 0 ? weights_.climb : 0.0;
    reach(Node(node + bits_.offset(d)), next, cost + length * field_.factor(next) + climb, d);
  }
}

void WeightedSearch::reach(Node node, Index3 at, double cost, int direction) {
  Label& held = labels_[node];
  if (held.query == query_ && held.cost <= cost) return;
  const double key = cost + estimate(at);
  if (key >= bound_) return;
  held = {cost, query_, std::uint8_t(direction), false};
  ++counters_.generated;
  for (std::size_t k = 0; k < goals_.size(); ++k) {
    if (!(goals_[k].cell == at)) continue;
    bound_ = cost;
    goal_ = k;
    return;
  }
  queue_.push(node, Cost(key * double(kUnit)), 0);
}

// Every factor is 1 or more, so the plain length is a lower bound; the climb to the goal is due
// in any case.
double WeightedSearch::estimate(Index3 at) const {
  if (!use_heuristic_) return 0.0;
  double least = kUnreached;
  for (const End& goal : goals_) {
    const double length = double(OctileHeuristic{}(at, goal.cell)) / double(kUnit) * (1.0 - 1e-10);
    least = std::min(least, length + weights_.climb * std::max(0, goal.cell.z - at.z));
  }
  return least;
}

void WeightedSearch::trace(VoxelPath& path) const {
  Index3 at = goals_[goal_].cell;
  path.goal = goal_;
  path.cost_voxels = bound_;
  path.cells.push_back(at);
  while (!(at == start_)) {
    at = at - step_of(labels_[bits_.node(at)].direction);
    path.cells.push_back(at);
  }
  std::reverse(path.cells.begin(), path.cells.end());
}

}  // namespace

std::unique_ptr<GridPlanner> make_weighted_search(std::string_view name, bool use_heuristic,
                                                  CornerRule rule, const Weights& weights) {
  return std::make_unique<WeightedSearch>(name, use_heuristic, rule, weights);
}

}  // namespace goshawk::path_search
