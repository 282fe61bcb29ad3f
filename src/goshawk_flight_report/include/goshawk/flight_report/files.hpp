#pragma once

#include <filesystem>

#include "goshawk/flight_report/flight.hpp"

namespace goshawk::flight_report {

/// Tables and meshes of a flight. All fail with invalid_input if Flight::check() does, and with
/// io_failed if the file cannot be written. Numbers read back exactly.

/// t_s,x_m,y_m,z_m,vx_m_s,vy_m_s,vz_m_s,qw,qx,qy,qz: one row a flown sample
Status write_flown_csv(const Flight& flight, const std::filesystem::path& file);

/// leg,t_s,x_m,...,vx_m_s,...,ax_m_s2,...,jx_m_s3,...: each leg's trajectory in even steps of at
/// most step_s, on the flight's clock
/// @param step_s [s] > 0; invalid_input otherwise, and for more than 10^7 rows
Status write_trajectory_csv(const Flight& flight, const std::filesystem::path& file,
                            double step_s = 0.01);

/// All polytopes of all legs as one ASCII PLY; every face carries the numbers of its leg and its
/// polytope. An unbounded polytope is cut off at 1e4 m.
Status write_corridor_ply(const Flight& flight, const std::filesystem::path& file);

/// All of it into one folder that exists: top.png, side.png, time.png (if there is a trajectory or
/// a flown track), flown.csv, trajectory.csv, corridor.ply.
Status write_flight_folder(const Flight& flight, const std::filesystem::path& folder);

}  // namespace goshawk::flight_report
