#pragma once

#include <span>

#include "goshawk/core/trajectory.hpp"
#include "goshawk/guard/plan.hpp"

namespace goshawk::guard {

/// A plan in quintic Bezier pieces.
struct Curve {
  Trajectory trajectory;
  double deviation_m = 0.0;  // proved: no point of it is further from what the plan describes
};

/// Exact, up to rounding: each span by knot insertion (blossoming; Ramshaw, "Blossoms are polar
/// forms", CAGD 1989), then its degree is raised.
/// @return invalid_input: degree outside of 2 to 5, sizes that disagree, knots that fall or are
///   closer than kLeastPiece_s but not equal, too many pieces, a number that is not finite or
///   beyond kFarthest_m
Result<Curve> curve_of(const Bspline& spline);

/// Exact up to the fifth degree, by change of basis. Beyond it quintics with the same states at
/// their ends are fitted to ever shorter parts, until the hull of the difference proves
/// kPolynomialWithin_m.
/// @return invalid_input, also for a degree above 9 or a piece shorter than kLeastPiece_s;
///   trajectory_infeasible: a polynomial that no quintics come so near to
Result<Curve> curve_of(const Polynomials& polynomials);

/// Through the samples, at their times; samples closer in time than kShortestPiece_s are left out,
/// and bounded. With velocities for all: quintics with these (accelerations, if missing, from the
/// differences of the velocities). Without: the cubic spline with continuous acceleration that ends
/// at rest. The deviation is from the polyline through the samples.
/// @return invalid_input: fewer than two, times that do not grow, not finite or beyond kFarthest_m
Result<Curve> curve_of(const Samples& samples);

/// @return invalid_input: no two different points, too many, or one that is not finite
Status check(const Waypoints& waypoints);

/// [m] A bound of how far any point of a trajectory is from a polyline: parts of each piece are
/// held against the segment that suits them best (the distance to a segment is convex, so that
/// control points bound it). @pre two points or more
double deviation_from(const Trajectory& trajectory, std::span<const Vec3> polyline);

/// Points on a trajectory, and a bound of how far it is from the polyline through them.
struct Outline {
  std::vector<Vec3> points_map;
  double deviation_m = 0.0;
};
/// @param from_s [s] where it begins
Outline outline(const Trajectory& trajectory, double from_s);

/// Fewer points: none that is left out is further than `within_m` from the polyline that stays.
/// Neighbours differ. @return the points and the largest distance
Outline simplified(std::span<const Vec3> points, double within_m);

/// What is left of a trajectory from t_s on (de Casteljau). @param t_s [s] in [0, duration)
Trajectory remainder(const Trajectory& trajectory, double t_s);

inline constexpr std::size_t kMostPieces = 1000;    // of a plan
inline constexpr std::size_t kMostPoints = 20'000;  // of a path or a list of samples
inline constexpr double kPolynomialWithin_m = 1e-3;
inline constexpr double kLeastPiece_s = 1e-3;     // of a plan: of shorter ones rounding is fast
inline constexpr double kShortestPiece_s = 0.05;  // of samples
inline constexpr double kFarthest_m = 1e6;        // no plan leads beyond

}  // namespace goshawk::guard
