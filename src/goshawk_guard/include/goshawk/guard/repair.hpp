#pragma once

#include <memory>
#include <vector>

#include "goshawk/core/certified_trajectory.hpp"
#include "goshawk/core/grid_geometry.hpp"

namespace goshawk::guard {

/// A way to fly along a polyline.
struct RepairTask {
  FlatState start;                  // at the first point
  std::vector<Vec3> points_map;     // two or more, neighbours differ; rest at the last
  double half_width_m = 0.1;        // of the tube around each segment that the way stays in
  double start_half_width_m = 0.1;  // the same around the first
  Limits limits;
  const VoxelGrid* map = nullptr;  // not null
};

/// Finds another trajectory along a path. Other stages' cores do it, so the guard's own core only
/// knows this.
class Repair {
 public:
  virtual ~Repair() = default;
  /// @return a trajectory from the start to rest at the last point, in the tube and free of the
  ///   map's obstacles, or why there is none
  virtual Result<CertifiedTrajectory> along(const RepairTask& task) = 0;
};

/// By the cores of corridor builder and trajectory optimizer: corridors around the path, cut to the
/// tube, and the fastest trajectory in them. In the library goshawk_guard::repair.
std::unique_ptr<Repair> make_repair();

}  // namespace goshawk::guard
