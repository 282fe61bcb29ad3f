#pragma once

#include <filesystem>
#include <vector>

#include "goshawk/flight_check/flight_check.hpp"

namespace goshawk::flight_check {

/// A flown track from a table with the columns t_s, x_m, y_m, z_m, qw, qx, qy, qz (in any order,
/// among others), as `goshawk fly` leaves it in flown.csv.
/// @return io_failed if the file cannot be read; invalid_input that names the missing column,
/// or the line that is wrong
Result<std::vector<Sample>> read_flown_csv(const std::filesystem::path& file);

/// One track for each leg of a planned table (leg, t_s, x_m, y_m, z_m, ax_m_s2, ay_m_s2, az_m_s2),
/// as in trajectory.csv. The attitude is what the acceleration asks for, with the yaw of the column
/// yaw_rad if there is one.
/// @param yaw_rad for a table without that column
Result<std::vector<std::vector<Sample>>> read_planned_csv(const std::filesystem::path& file,
                                                          double yaw_rad = 0.0);

}  // namespace goshawk::flight_check
