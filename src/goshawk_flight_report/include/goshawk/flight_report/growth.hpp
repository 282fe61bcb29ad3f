#pragma once

#include <filesystem>
#include <span>
#include <vector>

#include "goshawk/core/grid_geometry.hpp"

namespace goshawk::flight_report {

/// A map at one moment of a flight.
struct MapMoment {
  double t_s = 0.0;             // [s] since the recording began
  VoxelGrid grid;               // the window, known and grown
  std::vector<Vec3> track_map;  // [m] where the vehicle has been so far
};

/// From above, one panel a moment: what is known at the heights that the vehicle flew at, what was
/// learnt since the panel before, what is blocked, the window and the track.
/// @return invalid_input for no moment, more than 12, or numbers that are not finite; io_failed
Status draw_growth(std::span<const MapMoment> moments, const std::filesystem::path& png);

}  // namespace goshawk::flight_report
