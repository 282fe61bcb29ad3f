#pragma once

#include <filesystem>
#include <vector>

#include "goshawk/movers/motion.hpp"

namespace goshawk::movers {

/// A table with the columns t_s, x_m, y_m, z_m and, if there is one, yaw_rad, in any order.
/// @return io_failed if the file cannot be read; invalid_input with the line and the reason
Result<std::vector<Place>> read_track(const std::filesystem::path& file);

}  // namespace goshawk::movers
