#pragma once

#include <vector>

#include "goshawk/core/moving_box.hpp"
#include "goshawk_msgs.h"

namespace goshawk::conversions {

/// @return wrong_frame; invalid_input for more than kMostMovingBoxes, a repeated id, or a box
/// as MovingBox::check()
Result<std::vector<MovingBox>> from_msg(const goshawk_msgs::msg::MovingBoxes& m);
/// The header stays as it is.
void fill_msg(const std::vector<MovingBox>& boxes, goshawk_msgs::msg::MovingBoxes& m);

}  // namespace goshawk::conversions
