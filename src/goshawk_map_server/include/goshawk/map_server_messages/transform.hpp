#pragma once

#include "geometry_msgs.h"
#include "goshawk/core/result.hpp"
#include "goshawk/map_server/frame_tree.hpp"

namespace goshawk::map_server {

/// Takes one transform of /tf_static (fixed) or /tf into a tree of frames.
/// @return invalid_input for what is not finite or a quaternion of zeros, or as FrameTree::add
Status add_transform(const geometry_msgs::msg::TransformStamped& m, bool fixed, FrameTree& frames);

}  // namespace goshawk::map_server
