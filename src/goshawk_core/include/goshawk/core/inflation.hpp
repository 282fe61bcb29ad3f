#pragma once

#include "goshawk/core/bit_grid.hpp"

namespace goshawk {

/// Grows obstacles, conservatively and exactly (docs/method.md): a voxel of the result
/// is set when the distance between its cube and the cube of a set voxel is less than the radius.
/// Cubes that touch have distance 0, so any radius > 0 sets all 26 neighbours. What lies outside
/// the grid does not grow into it.
///
/// @param occupied obstacles
/// @param radius_m [m] finite, >= 0; 0 returns a copy
/// @param resolution_m [m] > 0
/// @return invalid_input for a radius or a resolution that is not allowed, map_empty for an empty
/// grid
Result<BitGrid> inflate(const BitGrid& occupied, double radius_m, double resolution_m);

}  // namespace goshawk
