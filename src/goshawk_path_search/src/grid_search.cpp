#include "goshawk/path_search/grid_search.hpp"

#include <bit>
#include <cmath>
#include <string>

#include "goshawk/path_search/bucket_queue.hpp"
#include "goshawk/path_search/labels.hpp"
#include "goshawk/path_search/move_cost.hpp"
#include "goshawk/path_search/move_rules.hpp"
#include "goshawk/path_search/obstacle_bits.hpp"

namespace goshawk::path_search {
namespace {

using Node = ObstacleBits::Node;

/// Heuristic: a functor of move_cost.hpp. kJumps: canonical successors and straight jumps.
template <typename Heuristic, bool kJumps>
class GridSearch final : public GridPlanner {
 public:
  GridSearch(std::string_view name, CornerRule rule)
      : name_(name), rule_(rule), rules_(move_rules(rule)) {}

  std::string_view name() const override { return name_; }
  void set_map(const BitGrid& blocked) override;
  Status search(Index3 start, Index3 goal, VoxelPath& path) override;

 private:
  Status check(Index3 start, Index3 goal) const;
  void run();
  void expand(Node node);
  void reach(Node node, Index3 at, Label label);
  int jump(const Move& move, Index3 from) const;
  void trace(VoxelPath& path) const;

  std::string_view name_;
  CornerRule rule_;
  const MoveRules& rules_;
  Error map_error_{ErrorCode::no_map, "no map yet: wait for one, or load one, before planning"};
  bool has_map_ = false;
  ObstacleBits bits_;
  LabelTable labels_;
  BucketQueue queue_;

  // Of the query at work.
  Index3 start_;
  Index3 goal_;
  Node goal_node_ = 0;
  Cost bound_ = 0;  // only paths below it are of interest: the best so far
  bool reached_ = false;
  bool too_long_ = false;  // something was left out because its cost does not fit a label
  Counters counters_;
};

Error too_large(Index3 size) {
  return fail(ErrorCode::map_too_large,
              "a map of " + to_text(size) +
                  " voxels is too large to search (8 bytes a voxel, at "
                  "most 2^32 voxels): use a coarser resolution or a smaller box");
}

template <typename Heuristic, bool kJumps>
void GridSearch<Heuristic, kJumps>::set_map(const BitGrid& blocked) {
  const bool same_size = has_map_ && bits_.size() == blocked.size();
  if (!same_size) {
    has_map_ = false;
    if (blocked.empty()) {
      map_error_ = fail(ErrorCode::no_map, "the map is empty: load one with at least one voxel");
      return;
    }
    const std::int64_t nodes = ObstacleBits::nodes_for(blocked.size());
    if (nodes == 0 || !labels_.resize(nodes)) {
      map_error_ = too_large(blocked.size());
      return;
    }
  }
  bits_.assign(blocked);
  has_map_ = true;
}

template <typename Heuristic, bool kJumps>
Status GridSearch<Heuristic, kJumps>::check(Index3 start, Index3 goal) const {
  if (!has_map_) return map_error_;
  const auto outside = [&](const char* name, Index3 i) {
    return std::string(name) + " voxel " + to_text(i) + " is outside the map of " +
           to_text(bits_.size()) + " voxels";
  };
  const auto occupied = [](const char* name, Index3 i) {
    return std::string(name) + " voxel " + to_text(i) + " is blocked: choose a free one";
  };
  if (!bits_.contains(start)) return fail(ErrorCode::start_outside, outside("start", start));
  if (!bits_.contains(goal)) return fail(ErrorCode::goal_outside, outside("goal", goal));
  if (bits_.blocked(bits_.node(start))) {
    return fail(ErrorCode::start_occupied, occupied("start", start));
  }
  if (bits_.blocked(bits_.node(goal))) {
    return fail(ErrorCode::goal_occupied, occupied("goal", goal));
  }
  return success();
}

template <typename Heuristic, bool kJumps>
Status GridSearch<Heuristic, kJumps>::search(Index3 start, Index3 goal, VoxelPath& path) {
  path.cells.clear();
  path.cost_voxels = 0.0;
  path.counters = {};
  if (auto status = check(start, goal); !status) return status;
  if (!labels_.start_query()) return too_large(bits_.size());
  start_ = start;
  goal_ = goal;
  run();
  path.counters = counters_;
  if (reached_) {
    trace(path);
    return success();
  }
  if (too_long_) {
    return fail(ErrorCode::solver_failed,
                "every path is longer than four million voxels, which this search does not "
                "follow: use a coarser resolution");
  }
  return fail(ErrorCode::no_path, "there is no free way from voxel " + to_text(start) + " to " +
                                      to_text(goal) +
                                      ": choose another goal, or a smaller radius or margin");
}

// A*, with nodes expanded again when a better way to them appears (which only happens within the
// width of a bucket, or under a heuristic that is not consistent), until nothing that is left
// can beat the way found to the goal.
template <typename Heuristic, bool kJumps>
void GridSearch<Heuristic, kJumps>::run() {
  const Cost estimate = Heuristic{}(start_, goal_);
  // Keys never fall below the first one if the heuristic is consistent; the Euclidean one is so
  // but for rounding, the Manhattan one is not.
  queue_.clear(std::is_same_v<Heuristic, OctileHeuristic> ? estimate : 0);
  counters_ = {};
  reached_ = too_long_ = false;
  bound_ = kMaxCost - kMoveCost[3] * ObstacleBits::kWindow;
  goal_node_ = bits_.node(goal_);
  reach(bits_.node(start_), start_, LabelTable::extend(labels_.root(), 0, kNoDirection));
  while (queue_.advance()) {
    const Cost lowest = queue_.lowest_key();
    if (lowest >= bound_) break;
    const BucketQueue::Entry entry = queue_.pop();
    if (lowest + entry.rest >= bound_ || (labels_[entry.node] & kExpanded) != 0) continue;
    expand(entry.node);
  }
}

template <typename Heuristic, bool kJumps>
void GridSearch<Heuristic, kJumps>::expand(Node node) {
  const Label label = labels_[node];
  labels_[node] = label | kExpanded;
  ++counters_.expanded;
  const Index3 at = bits_.index(node);
  const int arrival = kJumps ? LabelTable::direction(label) : kNoDirection;
  BlockMask moves = rules_.successors(arrival, bits_.block(node));
  // Two passes, so that the labels come from memory at the same time.
  struct Edge {
    Node node;
    int direction;
    int count;
  };
  std::array<Edge, kDirections> edges;
  std::size_t made = 0;
  for (; moves != 0; moves &= moves - 1) {
    const int d = std::countr_zero(moves);
    const int count = kJumps ? jump(kMoves[std::size_t(d)], at) : 1;
    if (count <= 0) continue;
    const Node next = Node(node + count * bits_.offset(d));
    labels_.prefetch(next);
    edges[made++] = {next, d, count};
  }
  for (std::size_t k = 0; k < made; ++k) {
    const Edge& edge = edges[k];
    const Move& move = kMoves[std::size_t(edge.direction)];
    const Index3 next{at.x + edge.count * move.step.x, at.y + edge.count * move.step.y,
                      at.z + edge.count * move.step.z};
    reach(edge.node, next, LabelTable::extend(label, edge.count * move.cost, edge.direction));
  }
}

// How many moves of this kind make one edge of the search; 0 or less for a dead end.
template <typename Heuristic, bool kJumps>
int GridSearch<Heuristic, kJumps>::jump(const Move& move, Index3 from) const {
  if (move.axis < 0) return 1;
  const int count = bits_.straight_jump(rule_, move.axis, move.sign, from);
  // The goal ends a jump, too.
  const Index3 left = goal_ - from;
  const int along = move.sign * (move.axis == 0 ? left.x : move.axis == 1 ? left.y : left.z);
  const bool in_line = std::abs(left.x) + std::abs(left.y) + std::abs(left.z) == along;
  return in_line && along > 0 && along <= std::abs(count) ? along : count;
}

template <typename Heuristic, bool kJumps>
void GridSearch<Heuristic, kJumps>::reach(Node node, Index3 at, Label label) {
  Label& held = labels_[node];
  if (!LabelTable::improves(label, held)) return;
  const Cost cost = labels_.cost(label);
  const Cost key = cost + Heuristic{}(at, goal_);
  if (key >= bound_) {
    too_long_ |= !reached_;
    return;
  }
  held = label;
  ++counters_.generated;
  if (node == goal_node_) {
    bound_ = cost;
    reached_ = true;
  } else {
    queue_.push(node, key);
  }
}

// Back from the goal against the directions of arrival. Voxels inside a jump have no label that
// fits; the first one behind whose label accounts for the cost is where the jump began.
template <typename Heuristic, bool kJumps>
void GridSearch<Heuristic, kJumps>::trace(VoxelPath& path) const {
  Node node = goal_node_;
  Index3 at = goal_;
  Label label = labels_[node];
  Cost cost = labels_.cost(label);
  std::array<std::int64_t, 4> moves{};
  path.cells.push_back(at);
  while (!(at == start_)) {
    const int d = LabelTable::direction(label);
    const auto axes = std::size_t(axes_changed(d));
    at = at - step_of(d);
    node = Node(node - bits_.offset(d));
    cost -= kMoveCost[axes];
    ++moves[axes];
    path.cells.push_back(at);
    const Label held = labels_[node];
    if (labels_.is_current(held) && labels_.cost(held) <= cost) {
      label = held;
      cost = labels_.cost(held);
    }
  }
  std::reverse(path.cells.begin(), path.cells.end());
  path.cost_voxels =
      double(moves[1]) + double(moves[2]) * std::sqrt(2.0) + double(moves[3]) * std::sqrt(3.0);
}

}  // namespace

std::unique_ptr<GridPlanner> make_grid_search(Variant variant, CornerRule rule) {
  switch (variant) {
    case Variant::jastar:
      return std::make_unique<GridSearch<OctileHeuristic, true>>("jastar", rule);
    case Variant::astar:
      return std::make_unique<GridSearch<OctileHeuristic, false>>("astar", rule);
    case Variant::astar_euclidean:
      return std::make_unique<GridSearch<EuclideanHeuristic, false>>("astar_euclidean", rule);
    case Variant::astar_manhattan:
      return std::make_unique<GridSearch<ManhattanHeuristic, false>>("astar_manhattan", rule);
    case Variant::dijkstra:
      return std::make_unique<GridSearch<ZeroHeuristic, false>>("dijkstra", rule);
  }
  throw std::logic_error("a search variant without an implementation");
}

}  // namespace goshawk::path_search
