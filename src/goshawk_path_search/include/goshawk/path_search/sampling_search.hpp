#pragma once

#include <memory>

#include "goshawk/path_search/planner.hpp"

namespace goshawk::path_search {

struct SamplingOptions {
  int max_iterations = 2000;  // samples; rrt ends with its first path, the others use all
  double step_voxels = 5.0;   // longest edge of a tree
  std::uint64_t seed = 1;
  Validity validity = Validity::grid;
};

/// RRT (LaValle 1998), RRT* (Karaman and Frazzoli 2011) and PRM (Kavraki et al. 1996) from OMPL,
/// on the grid: an edge is valid where the chosen validity says so, whatever the corner rule.
///
/// A query that ends by its iterations gives the same path bit for bit each time. Where its
/// deadline ends it, RRT* and PRM give the best path so far, deadline_exceeded if there is none;
/// no_path means that the iterations did not suffice, not that there is none.
/// Counters: expanded are iterations, generated the nodes of tree or road map.
/// @param planner rrt, rrtstar or prm; others throw std::invalid_argument
std::unique_ptr<GridPlanner> make_sampling_search(Planner planner, const SamplingOptions& options);

}  // namespace goshawk::path_search
