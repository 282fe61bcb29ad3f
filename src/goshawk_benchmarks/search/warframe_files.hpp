#pragma once

#include <string>
#include <vector>

#include "goshawk/core/bit_grid.hpp"
#include "goshawk/core/result.hpp"

namespace worlds {

/// One line of a .3dscen file.
struct Problem {
  goshawk::Index3 start;
  goshawk::Index3 goal;
  double length_voxels = 0.0;  // of a shortest path under the no-squeeze rule, as published
};

/// Reads a .3dmap file: "voxel X Y Z", then one occupied voxel a line.
/// @return map_unreadable, map_malformed or map_too_large
goshawk::Result<goshawk::BitGrid> read_voxel_map(const std::string& path);

/// Reads a .3dscen file: two lines of heading, then start, goal, length and a ratio a line.
/// @return map_unreadable or map_malformed, with the number of the line
goshawk::Result<std::vector<Problem>> read_scenario(const std::string& path);

}  // namespace worlds
