#pragma once

#include "chain.hpp"

namespace goshawk::corridor_builder {

/// The largest ball that each two consecutive polytopes share.
void measure_overlaps(Chain& chain);

/// Leaves out polytopes whose neighbours share a ball of at least half a voxel that is not much
/// smaller (0.7) than the ones it had with them; the first (last) if the next (previous) one
/// holds the start (goal) with `start_room_m` (`goal_room_m`) to spare. Start and goal stay
/// connected, so a path inside the polytopes remains.
void drop_covered(double resolution_m, double start_room_m, double goal_room_m, Chain& chain);

/// Moves every waypoint towards the centre of its overlap, only as far as it must to keep
/// `clearance_m` from all faces of both polytopes, or the ball's radius if that is less. Both
/// are convex and hold the ball, so that waypoints, and segments between them, are inside.
void settle_waypoints(double clearance_m, Chain& chain);

}  // namespace goshawk::corridor_builder
