#pragma once

#include <vector>

#include "goshawk/core/limits.hpp"
#include "goshawk/core/polytope.hpp"
#include "goshawk/core/trajectory.hpp"

namespace goshawk::guard {

/// The largest use of speed, acceleration and jerk by a piece's control points; 1 is at the limit.
/// Acceleration and jerk count as what a slower flight would need: their square and cube root.
double use_of(const BezierPiece& piece, const Limits& limits);

/// The same at the piece's ends and its middle: what the curve itself uses at least.
double least_use_of(const BezierPiece& piece, const Limits& limits);

/// The same curve, with pieces cut in half (four times at the most) if their control points exceed
/// a limit: the hulls of shorter pieces lie closer to the curve.
Trajectory refined(const Trajectory& trajectory, const Limits& limits);

/// How many times slower the whole must be flown to keep the limits, and 1 if it does.
double slowness_of(const Trajectory& trajectory, const Limits& limits);

/// The same curve, so many times slower.
Trajectory slower(Trajectory trajectory, double factor);

/// A box around the control points of each piece, kBoxMargin_m wider; names it in the piece. The
/// boxes tell where the curve is. They may meet obstacles: that the curve does not is proved along
/// the curve itself (find_obstruction).
std::vector<Polytope> boxes_around(Trajectory& trajectory);

/// So that what is braked along the curve, in other pieces, stays in them.
inline constexpr double kBoxMargin_m = 0.01;

}  // namespace goshawk::guard
