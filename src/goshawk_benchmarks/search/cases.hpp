#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/report.hpp"
#include "search/worlds.hpp"

namespace goshawk::bench {

/// What the thesis' tables say of the same cell.
struct ThesisFigures {
  double time_ms = 0.0;
  double nodes = 0.0;
  double length_m = 0.0;
};

/// Planners on maps of one class. The name "plain_astar" is the baseline of plain_astar.hpp.
struct Case {
  std::string table = {};
  std::string map = {};
  std::optional<double> ratio = {};
  std::string rule = {};
  double resolution_m = 0.2;
  std::vector<worlds::World> worlds = {};
  std::vector<std::string> planners = {};
  std::vector<std::optional<ThesisFigures>> thesis = {};  // one a planner, or none at all
  double seconds_a_query = 0.05;                          // how long rounds go on, at most 15

  /// Map and ratio, for a picture.
  std::string label() const {
    return ratio ? map + ", " + std::to_string(*ratio).substr(0, 4) : map;
  }
};

/// Queries without a path are left out, in all of these. Adds one row a planner: the median over
/// all queries of the median time of each, medians of expanded nodes, mean length, median set-up
/// time of a map.
void measure(Report& report, Case c);

/// The same for the sampling planners beside JA*, through the whole stage with pruning.
void measure_sampling(Report& report, Case c);

/// One row a map for the cost of taking over a map: new, the same again, 1,000 changed voxels;
/// and the memory that planner and query took.
void measure_setup(Report& report, Case c);

/// Rows for the first map of a planner, of a new size, for the first query on it, and for the same
/// query again, over all queries of the worlds.
void measure_first(Report& report, const Case& c);

/// Rows for a goal that cannot be reached: on a new map, again on the same map, and after 1,000
/// voxels changed; and a flood from the start for comparison.
void measure_no_way(Report& report, const Case& c);

/// Rows for the same goal after the map changed a little and the start moved along the path:
/// searched again, and with reuse_path. @param boxes a box appears, else 1,000 voxels change
/// anywhere
void measure_replanning(Report& report, Case c, bool boxes);

/// One row a kind of pruning: waypoints and length before and after.
void measure_pruning(Report& report, Case c);

}  // namespace goshawk::bench
