#pragma once

#include <cstdint>

#include "goshawk/core/result.hpp"
#include "goshawk/map_server/placement.hpp"
#include "sensor_msgs.h"

namespace goshawk::map_server {

/// The points of a cloud, in its own frame, and their times if it has them: `time` (float, seconds
/// after the stamp), `t` or `offset_time` (uint32, nanoseconds after the stamp), `timestamp`
/// (double, seconds or nanoseconds of the stamp's clock). x, y, z are float32 or float64,
/// little-endian.
/// @return invalid_input that names what is missing or does not fit: fields, steps, bytes, times
Status read_cloud(const sensor_msgs::msg::PointCloud2& m, std::size_t max_points,
                  SensorCloud& cloud);

}  // namespace goshawk::map_server
