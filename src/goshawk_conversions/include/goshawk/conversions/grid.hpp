#pragma once

#include "goshawk/core/grid_geometry.hpp"
#include "goshawk/core/grid_update.hpp"
#include "goshawk_msgs.h"

namespace goshawk::conversions {

/// @return wrong_frame, invalid_input, map_empty or map_too_large if the message is wrong
Result<VoxelGrid> from_msg(const goshawk_msgs::msg::VoxelGrid& m);

/// Fills a message in place, so that a large map's buffers are used again. The header stays.
void fill_msg(const VoxelGrid& grid, goshawk_msgs::msg::VoxelGrid& m);

/// @return wrong_frame, or invalid_input if a brick lacks words
Result<GridUpdate> from_msg(const goshawk_msgs::msg::VoxelGridUpdate& m);
/// The header stays.
void fill_msg(const GridUpdate& update, goshawk_msgs::msg::VoxelGridUpdate& m);

}  // namespace goshawk::conversions
