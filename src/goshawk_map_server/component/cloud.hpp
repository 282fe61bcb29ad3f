#pragma once

#include <vector>

#include "goshawk/core/result.hpp"
#include "goshawk/core/vector.hpp"
#include "sensor_msgs.h"

namespace goshawk::map_server {

/// The points of a cloud, in its own frame; x, y, z must be float32, little-endian.
/// @return invalid_input that names what is missing or does not fit: fields, steps, bytes
Result<std::vector<Vec3>> points_of(const sensor_msgs::msg::PointCloud2& m);

}  // namespace goshawk::map_server
