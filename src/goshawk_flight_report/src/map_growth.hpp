#pragma once

#include <span>
#include <string>
#include <vector>

#include "goshawk/flight_report/map_timeline.hpp"

namespace goshawk::flight_report {

/// What a page plays of a map that grows: each moment says which voxels of one raster changed since
/// the moment before; before the first, all are free and unknown. Voxels that the window leaves
/// behind stay as they were.
struct MapGrowth {
  struct Change {
    double t_s = 0.0;
    Index3 window;          // first voxel of the map's window
    Index3 window_size;     // [voxel]
    std::string obstacles;  // runs of voxels that became obstacles or ceased to be
    std::string known;      // runs of voxels that became known or unknown
  };
  GridGeometry geometry;  // around all windows
  std::vector<Change> changes;
};

/// @return without changes if there are no moments with known bits, or a page could not draw a
/// raster around all of their windows. Moments on another raster than the last are left out
MapGrowth growth_of(std::span<const MapMoment> moments);

}  // namespace goshawk::flight_report
