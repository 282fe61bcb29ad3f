#pragma once

#include <cstdint>
#include <optional>

#include "goshawk/core/bit_grid.hpp"
#include "goshawk/map_server/octree.hpp"
#include "readers.hpp"

namespace goshawk::map_server {

/// A few points that lie far from all others, and the box of those.
struct Outliers {
  std::int64_t count = 0;
  Vec3 farthest_map = Vec3::Zero();
  Box rest;
};

/// The box of points. @param points at least one
Box box_of(const Points& points);

/// @param points [m] map, finite @return none if there are none, or too few points to tell
std::optional<Outliers> find_outliers(const Points& points, double resolution_m);

/// @return whether no voxel of the 26 around this one is occupied
bool is_alone(const BitGrid& occupied, Index3 voxel);

/// Clears the occupied voxels that are alone. @return how many there were
std::int64_t drop_lonely(BitGrid& occupied);

}  // namespace goshawk::map_server
