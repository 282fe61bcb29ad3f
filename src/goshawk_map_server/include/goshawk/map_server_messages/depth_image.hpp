#pragma once

#include <cstddef>
#include <cstdint>

#include "goshawk/core/result.hpp"
#include "goshawk/map_server/placement.hpp"
#include "sensor_msgs.h"

namespace goshawk::map_server {

/// A camera without distortion. Its frame: x right, y down, z forward.
struct Pinhole {
  std::uint32_t width = 0, height = 0;    // [pixel]
  double focal_x = 0.0, focal_y = 0.0;    // [pixel]
  double center_x = 0.0, center_y = 0.0;  // [pixel]
};

/// @return invalid_input for a matrix or a size of zeros, what is not finite, and a distortion
Result<Pinhole> read_camera_info(const sensor_msgs::msg::CameraInfo& m);

/// The points of a depth image in its camera's frame, all of the moment of its stamp. Pixels that
/// are zero, negative or not finite are missing returns.
/// @return invalid_input that names what does not fit: encoding, size, bytes
Status read_depth(const sensor_msgs::msg::Image& m, const Pinhole& camera, std::size_t max_points,
                  SensorCloud& cloud);

}  // namespace goshawk::map_server
