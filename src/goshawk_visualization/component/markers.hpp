#pragma once

#include "goshawk/conversions/plan.hpp"
#include "goshawk/core/grid_geometry.hpp"
#include "visualization_msgs.h"

namespace goshawk::viewer_bridge {

/// Cubes, coloured by height, of the occupied voxels that have a free neighbour.
/// @param most at most so many; where there are more, every second one, third one, ... is left
visualization_msgs::msg::Marker voxel_marker(const VoxelGrid& grid, int most,
                                             std::int64_t stamp_ns);

visualization_msgs::msg::Marker line_marker(const std::string& name,
                                            const std::vector<Vec3>& points, double width_m,
                                            const Vec3& rgb, std::int64_t stamp_ns);

/// The polytopes as translucent triangles, and their edges as lines.
std::vector<visualization_msgs::msg::Marker> corridor_markers(
    const std::vector<Polytope>& polytopes, std::int64_t stamp_ns);

/// Blue is slow, red is as fast as the limit.
visualization_msgs::msg::Marker trajectory_marker(const Trajectory& trajectory, double v_max_m_s,
                                                  std::int64_t stamp_ns);

}  // namespace goshawk::viewer_bridge
