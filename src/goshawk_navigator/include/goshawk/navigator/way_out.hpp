#pragma once

#include "goshawk/core/certified_trajectory.hpp"
#include "goshawk/core/free_space.hpp"

namespace goshawk::navigator {

/// From a place at rest where no plan may begin, because the map learnt obstacles near it late, a
/// straight way to the nearest voxel where one may: rest to rest, as fast as the limits allow. On
/// it the vehicle comes no nearer to any of these obstacles than it is at rest, and keeps the
/// inflation from all others (find_obstruction proves it, here and in the tracker).
///
/// @return start_occupied if there is no such way within kWayOut_m. @pre a map with raw voxels
Result<CertifiedTrajectory> way_out(const Vec3& rest_map, const FreeSpace& space,
                                    const Limits& limits);

inline constexpr double kWayOut_m = 1.0;

}  // namespace goshawk::navigator
