#pragma once

#include <memory>
#include <string>
#include <vector>

#include "goshawk/core/grid_geometry.hpp"

namespace goshawk::bench {

/// A made-up world, inflated by the vehicle, and pruned paths that JA* finds in it.
struct Scene {
  std::shared_ptr<const VoxelGrid> grid;  // with raw voxels
  std::vector<std::vector<Vec3>> paths_map;
};

/// Of one kind, size and density; 0.2 m voxels, inflated by 0.2 m.
/// @param paths wanted in each world; each at least three waypoints long
/// @return fewer worlds if a seed gives none
std::vector<Scene> make_scenes(const std::string& kind, const Vec3& size_m, double density,
                               int worlds, int paths);

/// One room of 8 x 8 x 4 m with obstacles, in the corner of a map that is `side_m` wide.
Scene room_in_a_map(double side_m);

}  // namespace goshawk::bench
