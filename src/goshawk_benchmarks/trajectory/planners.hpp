#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "goshawk/baselines/baseline_optimizer.hpp"
#include "goshawk/core/grid_geometry.hpp"
#include "goshawk/core/trajectory.hpp"
#include "goshawk/corridor_builder/corridor_builder.hpp"
#include "goshawk/path_search/path_search.hpp"
#include "goshawk/trajectory_optimizer/trajectory_optimizer.hpp"

namespace goshawk::bench {

/// From a start to a goal, both at rest.
struct Task {
  std::string world;     // for the rows
  double density = 0.0;  // of the grown map
  std::shared_ptr<const VoxelGrid> grid;
  Vec3 start, goal;
  Limits limits;
};

/// What one planner made of one task, and how long each stage took.
struct Flight {
  bool solved = false;
  bool certified = false;
  double search_ms = 0.0, corridor_ms = 0.0, optimise_ms = 0.0;
  double path_length_m = 0.0;  // of the waypoints
  Trajectory trajectory;

  double plan_ms() const { return search_ms + corridor_ms + optimise_ms; }
};

/// A whole planner: search, corridor if it has one, trajectory.
class Planner {
 public:
  /// goshawk: JA*, corridor, time and shape together; and the three of the thesis' Table 3:
  /// thesis: JA*, corridor, one quintic a segment; minimum_snap (its Ref. [40]): RRT* and minimum
  /// snap, no corridor; minimum_jerk (its Ref. [42]): A*, corridor, polynomial that is checked and
  /// planned again
  static const std::vector<std::string>& names();

  /// @return nothing if a part of it is not built in
  static std::optional<Planner> make(const std::string& name);

  const std::string& name() const { return name_; }
  /// Searches by sampling, which takes a second or so.
  bool samples() const { return name_ == "minimum_snap"; }
  /// Plans twice and measures the second time, when memory is there; once if it samples.
  Flight fly(const Task& task);

 private:
  Flight plan(const Task& task);
  Result<Trajectory> optimise(const Task& task, const Corridor& corridor);

  std::string name_;
  std::optional<path_search::PathSearch> search_;
  std::optional<corridor_builder::CorridorBuilder> builder_;  // none: minimum snap
  std::optional<trajectory_optimizer::TrajectoryOptimizer> optimizer_;
  std::optional<baselines::BaselineOptimizer> baseline_;
};

/// The second opinion: every 5 ms of the curve against the grown map, sharing nothing with the
/// planners. A point that only touches a blocked voxel is free.
bool is_safe(const Trajectory& trajectory, const VoxelGrid& grid);

}  // namespace goshawk::bench
