#pragma once

#include <string>

#include "goshawk/core/grid_geometry.hpp"
#include "goshawk_msgs.h"

/// Whether a result is right, judged from the message and the map alone: nothing here calls a
/// stage, nor the functions that stages use to convince themselves.
namespace goshawk::conformance {

namespace msg = goshawk_msgs::msg;

/// @return empty, or what is wrong, in a sentence
std::string fault_of(const msg::Path& path, const msg::PlanRequest& sent, const VoxelGrid& grid);
std::string fault_of(const msg::Corridor& corridor, const msg::Path& sent, const VoxelGrid& grid);
std::string fault_of(const msg::BezierTrajectory& trajectory, const msg::Corridor& sent,
                     const VoxelGrid& grid);

}  // namespace goshawk::conformance
