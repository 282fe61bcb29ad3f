#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string_view>
#include <vector>

#include "goshawk/core/bit_grid.hpp"
#include "goshawk/core/result.hpp"
#include "goshawk/path_search/config.hpp"
#include "goshawk/path_search/query.hpp"

namespace goshawk::path_search {

/// What a search did. A node is expanded when its successors are made, generated when it is put
/// into the queue; one that is improved after its expansion counts again.
struct Counters {
  std::int64_t expanded = 0;
  std::int64_t generated = 0;
  friend bool operator==(const Counters&, const Counters&) = default;
};

/// A path through the grid.
struct VoxelPath {
  std::vector<Index3> cells;  // every voxel from start to goal, consecutive ones are neighbours
  std::vector<Vec3> points;   // [voxel units] of a sampling planner instead: a free polyline
  double cost_voxels = 0.0;   // what the search minimises; plain: length in voxel edges
  std::size_t goal = 0;       // which of the query's goals was reached
  Counters counters;

  /// Keeps the memory.
  void clear() {
    cells.clear();
    points.clear();
    cost_voxels = 0.0;
    goal = 0;
    counters = {};
  }
};

/// A search over a voxel grid. Implementations are deterministic; one object is for one thread.
class GridPlanner {
 public:
  virtual ~GridPlanner() = default;

  /// The word of Config::planner, or, if weights take another search, that one's name.
  virtual std::string_view name() const = 0;

  /// Takes over the obstacles; a copy of the grid is kept, which shares its chunks. Of a map of the
  /// same size as before only the chunks that differ are looked at; a new size allocates. A map that
  /// cannot be searched (empty, or more than 2^32 voxels) is reported by search().
  void set_map(const BitGrid& blocked) { set_map(blocked, nullptr); }
  /// @param known of the same size: Weights::unknown is for the voxels that are not set in it; null
  /// if all are known. Planners without weights ignore it
  virtual void set_map(const BitGrid& blocked, const BitGrid* known) = 0;

  /// @param path overwritten; its capacity is reused, so that a repeated query allocates nothing.
  /// After a failure its counters stand
  /// @return no_map, map_too_large, start_outside, start_occupied, goal_outside, goal_occupied,
  /// no_path, deadline_exceeded, cancelled, invalid_input for no goals at all, or solver_failed
  /// where the path would be longer than four million voxels
  virtual Status search(const GridQuery& query, VoxelPath& path) = 0;

  /// The same from voxel to voxel, for as long as it takes.
  Status search(Index3 start, Index3 goal, VoxelPath& path);
  Result<VoxelPath> search(Index3 start, Index3 goal);
};

/// What every planner asks of a query before it searches. @return the codes of search()
Status check_ends(const GridQuery& query, Index3 size,
                  const std::function<bool(Index3)>& is_blocked);

/// no_path, in a sentence.
Error no_way(const GridQuery& query);

/// @param resolution_m [m] of the maps that come; lengths in the configuration are scaled by it
/// @return the planner that the configuration names; with weights, one that is exact about them.
/// invalid_parameter where the configuration is wrong, or asks for what that planner cannot do
Result<std::unique_ptr<GridPlanner>> make_planner(const Config& config, double resolution_m = 0.2);

}  // namespace goshawk::path_search
