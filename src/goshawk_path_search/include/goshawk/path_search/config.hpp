#pragma once

#include <concepts>
#include <string>
#include <type_traits>

#include "goshawk/core/parameter.hpp"
#include "goshawk/core/result.hpp"
#include "goshawk/path_search/choices.hpp"

namespace goshawk::path_search {

/// The parameters of the stage. The defaults suit a corridor builder behind it: the shortest path,
/// the ends as they are, unknown space as the map has it.
struct Config {
  Planner planner = Planner::jastar;
  CornerRule corner_rule = CornerRule::no_squeeze;
  Pruning pruning = Pruning::shortest;
  double time_limit_s = 10.0;
  bool reuse_path = false;

  double move_within_m = 0.0;
  bool nearest_reachable = false;
  std::string search_box;

  double z_weight = 0.0;
  UnknownRule unknown = UnknownRule::as_mapped;
  double unknown_weight = 1.0;
  double clearance_m = 0.0;
  double clearance_weight = 1.0;

  Validity validity = Validity::grid;
  int max_iterations = 2000;
  double step_m = 1.0;
  int seed = 1;
};

/// Everything that is out of range or not a choice, in one sentence each.
/// @return invalid_parameter
Status check(const Config& config);

template <typename Self, typename Visitor>
requires std::same_as<std::remove_const_t<Self>, Config>
void describe(Self& c, Visitor&& visit) {
  visit("planner", c.planner, "",
        "grid search: jastar (fastest, exact), astar (octile heuristic), astar_euclidean, "
        "astar_manhattan (fast, not exact) or dijkstra; by sampling (OMPL): rrt, rrtstar or prm",
        AtRunTime{Anything{}});
  visit("corner_rule", c.corner_rule, "",
        "no_squeeze: every voxel of the box that a move spans is free, as a corridor needs; "
        "squeeze: only the target voxel is, so paths may touch obstacle edges",
        AtRunTime{Anything{}});
  visit("pruning", c.pruning, "",
        "waypoints: shortest (shortest polyline over the path's own nodes), relaxed (that, pulled "
        "tight off the voxel centres: shorter, but along obstacles), greedy (farthest visible "
        "node) or none",
        AtRunTime{Anything{}});
  visit("time_limit_s", c.time_limit_s, "s",
        "longest search; a request's own deadline may be shorter", AtRunTime{Range::positive(1e6)});
  visit(
      "reuse_path", c.reuse_path, "",
      "for the same goal again, with the start on the last path: keep the rest of that path while "
      "no change of the map blocks it or could make a shorter one; a path's length is as without, "
      "of equally long paths it may be another one; jastar, astar, astar_euclidean, dijkstra",
      AtRunTime{Anything{}});
  visit("move_within_m", c.move_within_m, "m",
        "a start or goal in an obstacle is moved to the nearest free voxel up to this far; 0: it "
        "is refused",
        AtRunTime{Range{0.0, 100.0}});
  visit("nearest_reachable", c.nearest_reachable, "",
        "where every goal is cut off, plan to the reachable voxel nearest to one",
        AtRunTime{Anything{}});
  visit("search_box", c.search_box, "m",
        "limits the search: x0,y0,z0,x1,y1,z1 in frame map; empty: the whole map",
        AtRunTime{Anything{}});
  visit("z_weight", c.z_weight, "", "each metre of climb costs as much as so many metres of path",
        AtRunTime{Range{0.0, 1e3}});
  visit("unknown", c.unknown, "",
        "space never measured: as_mapped, blocked, free, or costly; the last two ask for a map "
        "that leaves it free (map_server: unknown: free)",
        AtRunTime{Anything{}});
  visit("unknown_weight", c.unknown_weight, "",
        "where unknown is costly: a move into it costs 1 + this times its length",
        AtRunTime{Range{0.0, 1e3}});
  visit("clearance_m", c.clearance_m, "m",
        "voxels nearer than this to a blocked one cost more; 0: off", AtRunTime{Range{0.0, 10.0}});
  visit("clearance_weight", c.clearance_weight, "",
        "a move beside a blocked voxel costs 1 + this times its length, falling to 1 at "
        "clearance_m",
        AtRunTime{Range{0.0, 1e3}});
  visit("validity", c.validity, "",
        "rrt, rrtstar, prm: what says that a segment is free: grid (exact line of sight) or fcl "
        "(collision checks of the Flexible Collision Library; slower, for comparisons)",
        AtRunTime{Anything{}});
  visit("max_iterations", c.max_iterations, "",
        "rrt, rrtstar, prm: samples before giving up (rrt) or being content",
        AtRunTime{Range{1.0, 1e8}});
  visit("step_m", c.step_m, "m", "rrt, rrtstar: longest edge of the tree",
        AtRunTime{Range::positive(1e3)});
  visit("seed", c.seed, "", "rrt, rrtstar, prm: the same seed gives the same path",
        AtRunTime{Range{0, 1e9}});
}

}  // namespace goshawk::path_search
