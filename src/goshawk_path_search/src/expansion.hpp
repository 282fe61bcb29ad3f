#pragma once

#include <bit>
#include <cstdlib>

#include "best_first_search.hpp"
#include "goshawk/path_search/neighbour_labels.hpp"

/// How a node of GridSearch makes its successors: which moves now and which later, and how far.
namespace goshawk::path_search::best_first {

// Moves put off cost a push and a pop: not worth it for so few of them, at the first visit and
// when they were put off before.
inline constexpr int kFewAtFirst = 1;
inline constexpr int kFewLater = 8;

// To look at the labels of all neighbours at once pays where most of them are known: not in a
// search that ends soon.
inline constexpr std::int64_t kExpansionsUnfiltered = 1024;

// @param key g + estimate of the node
template <typename Heuristic, bool kJumps, typename Labels>
void GridSearch<Heuristic, kJumps, Labels>::expand(Node node, Index3 at, Label& label, Cost key) {
  label |= kExpanded;
  ++counters_.expanded;
  const BlockMask block = bits_.block(node);
  BlockMask moves = kJumps ? rules_.successors(Labels::direction(label), block)
                           : MoveRules::allowed(rule_, block);
  if constexpr (kFilters) {
    if (counters_.expanded > kExpansionsUnfiltered) {
      moves &= improved_neighbours(labels_, bits_, node);
    }
  }
  if (moves == 0) return;
  if (!kOctile || goals_.size() > 1) return expand_all(node, at, label, moves, block);
  make_moves(node, at, label, key, moves, block, kFewAtFirst);
}

// @param moves that were put off when the node was expanded
template <typename Heuristic, bool kJumps, typename Labels>
void GridSearch<Heuristic, kJumps, Labels>::expand_rest(Node node, Index3 at, Label label,
                                                        BlockMask moves) {
  if constexpr (kFilters) moves &= improved_neighbours(labels_, bits_, node);
  if (moves == 0) return;
  const BlockMask block = kJumps ? bits_.block(node) : 0;
  const Cost key = labels_.cost(label) + OctileHeuristic{}(at, goal_.cell);
  make_moves(node, at, label, key, moves, block, kFewLater);
}

// With one goal and the octile estimate: the moves that raise the key least now, the others when
// their turn comes, unless they are so few that coming back costs more.
template <typename Heuristic, bool kJumps, typename Labels>
inline void GridSearch<Heuristic, kJumps, Labels>::make_moves(Node node, Index3 at, Label label,
                                                              Cost key, BlockMask moves,
                                                              BlockMask block, int few) {
  const SuccessorOrder::Case& order = order_.of(goal_.cell - at);
  BlockMask now = moves;
  if (!kJumps || key < put_off_until_) now = first_moves(node, key, moves, order, few);
  while (now != 0) {
    const int d = kJumps ? next_in_order(now) : std::countr_zero(now);
    now &= ~(BlockMask{1} << d);
    const Move& move = kMoves[std::size_t(d)];
    const int count = kJumps ? jump(move, d, node, at, label, block) : 1;
    if (count <= 0) continue;
    const Node next = Node(node + count * bits_.offset(d));
    const Label reached = Labels::extend(label, count * move.cost, d);
    if (count == 1) {
      reach(next, at + move.step, reached, key + order.rise[std::size_t(d)]);
    } else {
      const Index3 to{at.x + count * move.step.x, at.y + count * move.step.y,
                      at.z + count * move.step.z};
      reach(next, to, reached, labels_.cost(reached) + OctileHeuristic{}(to, goal_.cell));
    }
  }
}

// Puts off what raises the key more, if that is more than a few moves. @return the others
template <typename Heuristic, bool kJumps, typename Labels>
inline BlockMask GridSearch<Heuristic, kJumps, Labels>::first_moves(
    Node node, Cost key, BlockMask moves, const SuccessorOrder::Case& order, int few) {
  std::size_t level = 0;
  BlockMask now = moves & order.moves[0];
  while (now == 0 && level + 1 < SuccessorOrder::kLevels) now = moves & order.moves[++level];
  const BlockMask later = moves & ~now;
  if (at_most(level == 0 ? few : kFewLater, later)) return moves;
  do ++level;
  while ((later & order.moves[level]) == 0);
  const Cost later_key = key + order.least[level];
  if (later_key < bound_) {
    queue_.push(node, later_key, later);
  } else {
    too_long_ |= !reached_;
  }
  return now;
}

template <typename Heuristic, bool kJumps, typename Labels>
void GridSearch<Heuristic, kJumps, Labels>::expand_all(Node node, Index3 at, Label label,
                                                       BlockMask moves, BlockMask block) {
  for (; moves != 0; moves &= moves - 1) {
    const int d = std::countr_zero(moves);
    const Move& move = kMoves[std::size_t(d)];
    const int count = kJumps ? jump(move, d, node, at, label, block) : 1;
    if (count <= 0) continue;
    const Index3 to{at.x + count * move.step.x, at.y + count * move.step.y,
                    at.z + count * move.step.z};
    const Label reached = Labels::extend(label, count * move.cost, d);
    reach(Node(node + count * bits_.offset(d)), to, reached, labels_.cost(reached) + estimate(to));
  }
}

// How many moves of this kind make one edge of the search; 0 or less for a dead end, or if the
// first voxel has a label as good: it makes its own moves, so what lies behind is reached as
// cheaply.
template <typename Heuristic, bool kJumps, typename Labels>
int GridSearch<Heuristic, kJumps, Labels>::jump(const Move& move, int direction, Node node,
                                                Index3 from, Label label, BlockMask block) {
  if (move.axis < 0) return 1;
  // Where the ring around the next voxel differs from the one here, a jump would mostly end there.
  if (MoveRules::ring_changes(move, block)) return 1;
  const Label first = labels_.held(Node(node + bits_.offset(direction)), from + move.step);
  if (!Labels::improves(Labels::extend(label, move.cost, direction), first)) return 0;
  int count = bits_.straight_jump(rule_, move.axis, move.sign, from);
  for (const Goal& goal : goals_) count = jump_ends(move, from, goal.cell, count);
  return count;
}

// The goal ends a jump, too.
template <typename Heuristic, bool kJumps, typename Labels>
int GridSearch<Heuristic, kJumps, Labels>::jump_ends(const Move& move, Index3 from, Index3 goal,
                                                     int count) const {
  const Index3 left = goal - from;
  const int along = move.sign * (move.axis == 0 ? left.x : move.axis == 1 ? left.y : left.z);
  const bool in_line = std::abs(left.x) + std::abs(left.y) + std::abs(left.z) == along;
  return in_line && along > 0 && along <= std::abs(count) ? along : count;
}

}  // namespace goshawk::path_search::best_first
