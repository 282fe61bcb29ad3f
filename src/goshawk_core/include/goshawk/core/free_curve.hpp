#pragma once

#include <limits>
#include <optional>
#include <string>

#include "goshawk/core/committed_trajectory.hpp"
#include "goshawk/core/free_space.hpp"

namespace goshawk {

/// Where a curve is no longer proved to be free.
struct Obstruction {
  double time_s = 0.0;  // [s] since the curve's start: it is free until then
  Index3 voxel;         // that is in the way; may lie outside the grid, which is blocked
};

/// Proves that a curve keeps out of a grid's blocked voxels, at all times and not only at samples:
/// the boxes around the control points of ever shorter parts of it (de Casteljau, hull property)
/// meet no blocked voxel. Faces may be touched, as a corridor's planes touch them: a voxel is in
/// the way if the curve enters it deeper than kTouch_m. Between two blocked voxels there is no way.
/// Exact up to that depth: what is reported is entered, or cannot be told from it. Allocates
/// nothing.
///
/// @param from_s, to_s [s] the part that is looked at, cut to the curve
/// @return the first obstruction, or nothing: then that part is free
std::optional<Obstruction> find_obstruction(const VoxelGrid& grid, const BezierPiece& curve,
                                            double from_s = 0.0,
                                            double to_s = std::numeric_limits<double>::infinity());
std::optional<Obstruction> find_obstruction(const VoxelGrid& grid, const Trajectory& trajectory,
                                            double from_s, double to_s);
/// The same for what the vehicle may fly through, which is not free where it was never seen. If
/// raw voxels decide (FreeSpace), the vehicle's ball around the curve is kept out of their cubes,
/// at all times; what is then reported is the cube. A trajectory that begins at rest may begin
/// nearer to cubes than the inflation, because the map learnt them late: it comes no nearer to any
/// of these than it is at rest. @pre a map has come
std::optional<Obstruction> find_obstruction(const FreeSpace& space, const BezierPiece& curve,
                                            double from_s = 0.0,
                                            double to_s = std::numeric_limits<double>::infinity());
std::optional<Obstruction> find_obstruction(const FreeSpace& space, const Trajectory& trajectory,
                                            double from_s = 0.0,
                                            double to_s = std::numeric_limits<double>::infinity());

inline constexpr double kTouch_m = 1e-5;

/// For sentences: "map 7 has an obstacle at (1, 2, 3) m".
std::string to_text(const VoxelGrid& grid, const Obstruction& found);

/// Is what is left of a committed trajectory free? Looks at what is flown when nothing newer comes.
/// @param from_s [s] since its start
/// @return trajectory_blocked, with time, place and map version
Status check_against(const VoxelGrid& grid, const CommittedTrajectory& committed, double from_s);
/// @pre a map has come
Status check_against(const FreeSpace& space, const CommittedTrajectory& committed, double from_s);

}  // namespace goshawk
