#pragma once

#include <string>
#include <vector>

#include "goshawk/conversions/plan.hpp"
#include "goshawk/map_server/voxel_map.hpp"
#include "nav_msgs.h"
#include "visualization_msgs.h"

/// What planners say, as messages that every ROS 2 viewer draws. Frame map, [m].
namespace goshawk::visualization {

using visualization_msgs::msg::Marker;

/// Cubes, coloured by height, of the occupied voxels that have a neighbour that is not occupied.
/// @param most at most this many; if there are more, every second, third, ... one is drawn
Marker voxel_marker(const map_server::RawVoxels& voxels, int most, std::int64_t stamp_ns);

Marker line_marker(const std::string& name, const std::vector<Vec3>& points, double width_m,
                   const Vec3& rgb, std::int64_t stamp_ns);

/// The polytopes' faces as translucent triangles.
Marker face_marker(const std::vector<Polytope>& polytopes, std::int64_t stamp_ns);

/// The polytopes' edges as lines, each once.
Marker edge_marker(const std::string& name, const std::vector<Polytope>& polytopes, double width_m,
                   std::int64_t stamp_ns);

/// Blue is slow, orange is as fast as the limit.
Marker trajectory_marker(const Trajectory& trajectory, double v_max_m_s, std::int64_t stamp_ns);

/// The trajectory from its start to its end, as points at most `step_s` apart.
nav_msgs::msg::Path path_line(const Trajectory& trajectory, double step_s, std::int64_t stamp_ns);

}  // namespace goshawk::visualization
