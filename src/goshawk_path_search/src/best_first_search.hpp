#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <type_traits>
#include <vector>

#include "goshawk/path_search/bucket_queue.hpp"
#include "goshawk/path_search/components.hpp"
#include "goshawk/path_search/labels.hpp"
#include "goshawk/path_search/move_cost.hpp"
#include "goshawk/path_search/move_rules.hpp"
#include "goshawk/path_search/obstacle_bits.hpp"
#include "goshawk/path_search/planner.hpp"
#include "goshawk/path_search/successor_order.hpp"
#include "goshawk/path_search/tiled_labels.hpp"
#include "goshawk/path_search/word_flood.hpp"
#include "move_sets.hpp"

/// The best-first search behind make_grid_search(), which alone includes this, together with
/// expansion.hpp: how a node makes its successors.
namespace goshawk::path_search::best_first {

using Node = ObstacleBits::Node;

inline constexpr int kExpansionsBetweenLooks = 1024;  // at the clock and the stop token

// Whether there is a way at all is found out beside the search. First a flood from the goals, so
// many words of it at each look: it seldom needs more than a thousand in all.
inline constexpr int kWordsALook = 512;
inline constexpr int kWordsOfFlood = 8192;

// After it the components of the map: so many bricks for each look so far. That costs a short
// search little, and a hopeless one ends soon in a map of any size.
inline constexpr int kBricksAtFirstLook = 32;

inline constexpr std::size_t kEntriesAtFirst = 4096;  // in the queue

// Where paths are longer than the empty grid's by this much, most canonical moves that are put off
// are made in the end.
inline constexpr Cost kPutOffDetour = kUnit;

/// Heuristic: a functor of move_cost.hpp. kJumps: canonical successors and straight jumps. Labels:
/// LabelTable or TiledLabels.
template <typename Heuristic, bool kJumps, typename Labels>
class GridSearch final : public GridPlanner {
 public:
  GridSearch(std::string_view name, CornerRule rule)
      : name_(name), rule_(rule), rules_(move_rules(rule)), components_(rule), flood_(rule) {}

  using GridPlanner::search;
  std::string_view name() const override { return name_; }
  using GridPlanner::set_map;
  void set_map(const BitGrid& blocked, const BitGrid* known) override;
  Status search(const GridQuery& query, VoxelPath& path) override;

 private:
  static constexpr bool kOctile = std::is_same_v<Heuristic, OctileHeuristic>;
  // To look at the labels of all neighbours at once takes a plain table.
  static constexpr bool kFilters = std::is_same_v<Labels, LabelTable>;

  void populate();
  Status check(const GridQuery& query) const;
  void prepare(const GridQuery& query);
  Status run(const StopSignal& stop);
  bool any_goal_is_joined() const;
  bool is_known_joined() const;
  bool is_known_hopeless() const;
  bool look_for_a_way();
  bool begin_flood();
  void expand(Node node, Index3 at, Label& label, Cost key);
  [[gnu::noinline]] void expand_rest(Node node, Index3 at, Label label, BlockMask moves);
  [[gnu::always_inline]] void make_moves(Node node, Index3 at, Label label, Cost key,
                                         BlockMask moves, BlockMask block, int few);
  BlockMask first_moves(Node node, Cost key, BlockMask moves, const SuccessorOrder::Case& order,
                        int few);
  void expand_all(Node node, Index3 at, Label label, BlockMask moves, BlockMask block);
  void reach(Node node, Index3 at, Label label, Cost key);
  int jump(const Move& move, int direction, Node node, Index3 from, Label label, BlockMask block);
  int jump_ends(const Move& move, Index3 from, Index3 goal, int count) const;
  Cost estimate(Index3 at) const;
  bool is_goal(Node node) const;
  void trace(VoxelPath& path) const;

  std::string_view name_;
  CornerRule rule_;
  const MoveRules& rules_;
  Error map_error_{ErrorCode::no_map, "no map yet: wait for one, or load one, before planning"};
  bool has_map_ = false;
  ObstacleBits bits_;
  Components components_;
  WordFlood flood_;
  Labels labels_;
  BucketQueue queue_;
  const SuccessorOrder& order_ = successor_order();

  // Of the query at work.
  struct Goal {
    Index3 cell;
    Node node;
    std::size_t index;  // in the query
  };
  Index3 start_;
  std::vector<Goal> goals_;  // without repetition
  Goal goal_{};              // the only one, or the one reached
  Cost put_off_until_ = 0;   // from this key on, a node makes all moves at once
  Cost bound_ = 0;           // only paths below it are of interest: the best so far
  bool reached_ = false;
  bool joined_ = false;    // start and goal, by flood_ or components_
  bool flooding_ = false;  // from the goals, on behalf of this query
  int looks_ = 0;
  bool too_long_ = false;  // something was left out because its cost does not fit a label
  Counters counters_;
};

inline Error too_large(Index3 size) {
  return fail(ErrorCode::map_too_large,
              "a map of " + to_text(size) +
                  " voxels is too large to search (8 bytes a voxel, at "
                  "most 2^32 voxels): use a coarser resolution or a smaller box");
}

template <typename Heuristic, bool kJumps, typename Labels>
void GridSearch<Heuristic, kJumps, Labels>::set_map(const BitGrid& blocked, const BitGrid*) {
  const bool same_size = has_map_ && bits_.size() == blocked.size();
  if (!same_size) {
    has_map_ = false;
    if (blocked.empty()) {
      map_error_ = fail(ErrorCode::no_map, "the map is empty: load one with at least one voxel");
      return;
    }
    const std::int64_t nodes = ObstacleBits::nodes_for(blocked.size());
    if (nodes == 0 || !labels_.resize(blocked.size(), nodes)) {
      map_error_ = too_large(blocked.size());
      return;
    }
  }
  if (bits_.assign(blocked)) {
    components_.forget();
    flood_.forget();
  }
  if (!same_size) populate();
  has_map_ = true;
}

template <typename Heuristic, bool kJumps, typename Labels>
void GridSearch<Heuristic, kJumps, Labels>::populate() {
  labels_.populate();
  if constexpr (kJumps) bits_.populate_jumps();
  queue_.reserve(kEntriesAtFirst);
}

template <typename Heuristic, bool kJumps, typename Labels>
Status GridSearch<Heuristic, kJumps, Labels>::check(const GridQuery& query) const {
  if (!has_map_) return map_error_;
  return check_ends(query, bits_.size(), [this](Index3 i) { return bits_.blocked(bits_.node(i)); });
}

template <typename Heuristic, bool kJumps, typename Labels>
Status GridSearch<Heuristic, kJumps, Labels>::search(const GridQuery& query, VoxelPath& path) {
  path.clear();
  if (auto status = check(query); !status) return status;
  if (!labels_.start_query()) return too_large(bits_.size());
  prepare(query);
  if (is_known_hopeless()) return no_way(query);
  Status ended = run(query.stop);
  path.counters = counters_;
  if (!ended) return ended;
  if (reached_) {
    path.goal = goal_.index;
    trace(path);
    return success();
  }
  if (too_long_) {
    return fail(ErrorCode::solver_failed,
                "every path is longer than four million voxels, which this search does not "
                "follow: use a coarser resolution");
  }
  return no_way(query);
}

template <typename Heuristic, bool kJumps, typename Labels>
void GridSearch<Heuristic, kJumps, Labels>::prepare(const GridQuery& query) {
  start_ = query.start.cell;
  goals_.clear();
  for (std::size_t k = 0; k < query.goals.size(); ++k) {
    const Index3 cell = query.goals[k].cell;
    if (!is_goal(bits_.node(cell))) goals_.push_back({cell, bits_.node(cell), k});
  }
  goal_ = goals_.front();
  // Keys never fall below the first one if the heuristic is consistent; the Euclidean one is so
  // but for rounding, the Manhattan one is not.
  queue_.clear(kOctile ? estimate(start_) : 0);
  put_off_until_ = estimate(start_) + kPutOffDetour;
  counters_ = {};
  reached_ = too_long_ = false;
  joined_ = is_known_joined();
  looks_ = 0;
  flooding_ = false;
  bound_ = kMaxCost - kMoveCost[3] * (ObstacleBits::kLongestJump + 1);
}

// A*, with nodes expanded again when a better way to them appears (which only happens within the
// width of a bucket, or under a heuristic that is not consistent), until nothing that is left
// can beat the way found to the goal.
template <typename Heuristic, bool kJumps, typename Labels>
Status GridSearch<Heuristic, kJumps, Labels>::run(const StopSignal& stop) {
  const Node start = bits_.node(start_);
  reach(start, start_, Labels::extend(labels_.root(), 0, kNoDirection), estimate(start_));
  int left = kExpansionsBetweenLooks;
  while (queue_.advance()) {
    const Cost lowest = queue_.lowest_key();
    if (lowest >= bound_) break;
    const BucketQueue::Entry entry = queue_.pop();
    // A node whose label has improved since is expanded by its newer entry.
    const Index3 at = bits_.index(entry.node);
    Label& label = labels_.at(entry.node, at);
    const bool expanded = (label & kExpanded) != 0;
    if (lowest + entry.rest >= bound_ || expanded != (entry.note != 0)) continue;
    if (--left == 0) {
      if (auto status = stop.check(); !status) return status;
      left = kExpansionsBetweenLooks;
      if (!joined_ && !look_for_a_way()) break;
    }
    if (expanded) {
      expand_rest(entry.node, at, label, entry.note);
    } else {
      expand(entry.node, at, label, lowest + entry.rest);
    }
  }
  return success();
}

template <typename Heuristic, bool kJumps, typename Labels>
bool GridSearch<Heuristic, kJumps, Labels>::any_goal_is_joined() const {
  return std::any_of(goals_.begin(), goals_.end(),
                     [this](const Goal& goal) { return components_.joined(start_, goal.cell); });
}

// By what earlier queries of this map found out.
template <typename Heuristic, bool kJumps, typename Labels>
bool GridSearch<Heuristic, kJumps, Labels>::is_known_joined() const {
  if (components_.ready()) return any_goal_is_joined();
  return std::any_of(goals_.begin(), goals_.end(),
                     [this](const Goal& goal) { return flood_.joins(start_, goal.cell); });
}

template <typename Heuristic, bool kJumps, typename Labels>
bool GridSearch<Heuristic, kJumps, Labels>::is_known_hopeless() const {
  if (components_.ready()) return !any_goal_is_joined();
  if (flood_.state() != WordFlood::State::closed || flood_.contains(start_)) return false;
  return std::all_of(goals_.begin(), goals_.end(),
                     [this](const Goal& goal) { return flood_.contains(goal.cell); });
}

template <typename Heuristic, bool kJumps, typename Labels>
bool GridSearch<Heuristic, kJumps, Labels>::begin_flood() {
  if (!flood_.start(bits_.map(), start_)) return false;
  for (const Goal& goal : goals_) flood_.add_source(bits_.map(), goal.cell);
  return true;
}

// A share of the work on the question whether there is a way at all: first a flood from the goals,
// which mostly meets the start soon or fills a small closed space; after kWordsOfFlood the
// components of the whole map. @return false once there is none
template <typename Heuristic, bool kJumps, typename Labels>
bool GridSearch<Heuristic, kJumps, Labels>::look_for_a_way() {
  if (looks_++ == 0) flooding_ = begin_flood();
  if (flooding_) {
    const WordFlood::State state = flood_.advance(bits_.map(), kWordsALook);
    joined_ = state == WordFlood::State::met;
    if (state != WordFlood::State::open) return joined_;
    flooding_ = flood_.words_done() < kWordsOfFlood;
    return true;
  }
  if (!components_.advance(bits_.map(), kBricksAtFirstLook * looks_)) return true;
  joined_ = any_goal_is_joined();
  return joined_;
}

template <typename Heuristic, bool kJumps, typename Labels>
Cost GridSearch<Heuristic, kJumps, Labels>::estimate(Index3 at) const {
  Cost least = Heuristic{}(at, goals_.front().cell);
  for (std::size_t k = 1; k < goals_.size(); ++k) {
    least = std::min(least, Heuristic{}(at, goals_[k].cell));
  }
  return least;
}

template <typename Heuristic, bool kJumps, typename Labels>
bool GridSearch<Heuristic, kJumps, Labels>::is_goal(Node node) const {
  for (const Goal& goal : goals_) {
    if (goal.node == node) return true;
  }
  return false;
}

template <typename Heuristic, bool kJumps, typename Labels>
void GridSearch<Heuristic, kJumps, Labels>::reach(Node node, Index3 at, Label label, Cost key) {
  if (key >= bound_) {
    too_long_ |= !reached_;
    return;
  }
  Label& held = labels_.at(node, at);
  if (!Labels::improves(label, held)) return;
  held = label;
  ++counters_.generated;
  for (const Goal& goal : goals_) {
    if (node != goal.node) continue;
    goal_ = goal;
    bound_ = labels_.cost(label);
    reached_ = true;
    return;
  }
  queue_.push(node, key, 0);
}

// Back from the goal against the directions of arrival. Voxels inside a jump have no label that
// fits; the first one behind whose label accounts for the cost is where the jump began.
template <typename Heuristic, bool kJumps, typename Labels>
void GridSearch<Heuristic, kJumps, Labels>::trace(VoxelPath& path) const {
  Node node = goal_.node;
  Index3 at = goal_.cell;
  Label label = labels_.held(node, at);
  Cost cost = labels_.cost(label);
  std::array<std::int64_t, 4> moves{};
  path.cells.push_back(at);
  while (!(at == start_)) {
    const int d = Labels::direction(label);
    const auto axes = std::size_t(axes_changed(d));
    at = at - step_of(d);
    node = Node(node - bits_.offset(d));
    cost -= kMoveCost[axes];
    ++moves[axes];
    path.cells.push_back(at);
    const Label held = labels_.held(node, at);
    if (labels_.is_current(held) && labels_.cost(held) <= cost) {
      label = held;
      cost = labels_.cost(held);
    }
  }
  std::reverse(path.cells.begin(), path.cells.end());
  path.cost_voxels =
      double(moves[1]) + double(moves[2]) * std::sqrt(2.0) + double(moves[3]) * std::sqrt(3.0);
}

}  // namespace goshawk::path_search::best_first
