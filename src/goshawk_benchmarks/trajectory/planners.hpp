#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

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
  std::string why;  // not solved
  double search_ms = 0.0, corridor_ms = 0.0, optimise_ms = 0.0;
  double path_length_m = 0.0;  // of the waypoints
  Trajectory trajectory;

  double plan_ms() const { return search_ms + corridor_ms + optimise_ms; }
};

/// A whole planner: search, corridor where it has one, trajectory.
class Planner {
 public:
  /// goshawk: JA*, corridor, time and shape together; thesis: JA*, corridor, one quintic a segment;
  /// ref40: RRT* and minimum snap, no corridor; ref42: A*, corridor, polynomial with re-checks
  /// (thesis, Table 3)
  static const std::vector<std::string>& names();

  /// @return nothing where a part of it is not built in
  static std::optional<Planner> make(const std::string& name);

  const std::string& name() const { return name_; }
  /// Plans twice and measures the second time, when memory is there.
  Flight fly(const Task& task);

 private:
  Flight plan(const Task& task);
  bool optimise(const Task& task, const std::vector<Vec3>& waypoints, const Corridor& corridor,
                Flight& flight);

  std::string name_;
  std::optional<path_search::PathSearch> search_;
  std::optional<corridor_builder::CorridorBuilder> builder_;
  std::optional<trajectory_optimizer::TrajectoryOptimizer> optimizer_;  // none: minimum snap
};

/// The second opinion: every 5 ms of the curve against the grown map, sharing nothing with the
/// planners. A point that only touches a blocked voxel is free.
bool is_safe(const Trajectory& trajectory, const VoxelGrid& grid);

}  // namespace goshawk::bench
