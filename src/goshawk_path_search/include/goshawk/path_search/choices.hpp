#pragma once

#include "goshawk/core/words.hpp"

namespace goshawk::path_search {

/// Which search.
enum class Planner {
  jastar,           // octile heuristic, canonical successors, straight jumps
  astar,            // octile heuristic, all successors
  astar_euclidean,  // Euclidean heuristic, all successors
  astar_manhattan,  // Manhattan heuristic, all successors; paths may be longer than the shortest
  dijkstra,         // no heuristic, all successors
  rrt,              // by sampling, from OMPL (sampling_search.hpp)
  rrtstar,
  prm,
};

/// When may a path move diagonally past blocked voxels? (docs/method.md)
enum class CornerRule {
  no_squeeze,  // every voxel of the box that the move spans is free
  squeeze,     // the target voxel is free
};

/// Which nodes of a path stay waypoints.
enum class Pruning {
  shortest,  // the shortest polyline over the path's own nodes
  relaxed,   // the nodes of shortest; relaxation.hpp then moves them
  greedy,    // thesis, Algorithm 2
  none,      // every node stays
};

/// How space that was never measured is taken.
enum class UnknownRule {
  as_mapped,  // as the map has it
  blocked,
  free,    // needs a map that leaves it free
  costly,  // needs a map that leaves it free
};

/// What decides for a sampling planner whether a segment is free (segment_validity.hpp).
enum class Validity { grid, fcl };

constexpr auto words_of(Planner) {
  using enum Planner;
  return std::to_array<Named<Planner>>({{jastar, "jastar"},
                                        {astar, "astar"},
                                        {astar_euclidean, "astar_euclidean"},
                                        {astar_manhattan, "astar_manhattan"},
                                        {dijkstra, "dijkstra"},
                                        {rrt, "rrt"},
                                        {rrtstar, "rrtstar"},
                                        {prm, "prm"}});
}

constexpr auto words_of(CornerRule) {
  using enum CornerRule;
  return std::to_array<Named<CornerRule>>({{no_squeeze, "no_squeeze"}, {squeeze, "squeeze"}});
}

constexpr auto words_of(Pruning) {
  using enum Pruning;
  return std::to_array<Named<Pruning>>(
      {{shortest, "shortest"}, {relaxed, "relaxed"}, {greedy, "greedy"}, {none, "none"}});
}

constexpr auto words_of(UnknownRule) {
  using enum UnknownRule;
  return std::to_array<Named<UnknownRule>>(
      {{as_mapped, "as_mapped"}, {blocked, "blocked"}, {free, "free"}, {costly, "costly"}});
}

constexpr auto words_of(Validity) {
  using enum Validity;
  return std::to_array<Named<Validity>>({{grid, "grid"}, {fcl, "fcl"}});
}

}  // namespace goshawk::path_search
