#pragma once

#include <string>
#include <vector>

#include "goshawk/map_server/map_file.hpp"
#include "readers.hpp"

namespace goshawk::map_server {

/// Adds to the error of a cloud whose raster is too large what it comes from, if that can be told: a
/// few points far from all others, coordinates far from the origin, millimetres.
/// @param points [m] map, finite, at least one
Error explain(Error error, const Points& points, const LoadOptions& options);

/// Notes what looks wrong about a cloud that was read: points far from all others, or farther apart
/// than a voxel, a unit that cannot be metres.
/// @param points [m] map, finite @param occupied their voxels
void note_oddities(const Cloud& cloud, const Points& points, const GridGeometry& geometry,
                   const BitGrid& occupied, std::vector<std::string>& notes);

/// Notes coordinates so large that 32-bit floats cannot tell one voxel from the next.
/// @param cloud as the file has it
void note_coarse_floats(const Cloud& cloud, const LoadOptions& options,
                        std::vector<std::string>& notes);

}  // namespace goshawk::map_server
