#pragma once

#include <span>
#include <vector>

#include "goshawk/core/trajectory.hpp"

// Bezier curves of any degree, as lists of control points.
namespace goshawk::guard {

/// Finite, and no coordinate beyond kFarthest_m.
bool is_within_reach(const Vec3& p_map);

/// The same curve with one control point more.
std::vector<Vec3> raised(std::span<const Vec3> points);

/// @pre six control points or fewer
BezierPiece quintic(std::vector<Vec3> points, double duration_s);

/// The curve's halves (de Casteljau).
struct Halves {
  std::vector<Vec3> first, second;
};
Halves halved(std::span<const Vec3> points);

/// c[i] of the curve a[0] + a[1] t + ... over [0, duration_s]. @param degree of the curve, as least
/// as high as the polynomial's
std::vector<double> bernstein(std::span<const double> coefficients, double duration_s, int degree);

/// [m] from a point to the segment from a to b
double distance_to_segment(const Vec3& p, const Vec3& a, const Vec3& b);

/// [m] largest distance of a piece's control points, and so of the piece, to a segment
double hull_distance(const BezierPiece& piece, const Vec3& a, const Vec3& b);

/// The piece in so many parts of equal duration.
std::vector<BezierPiece> parts_of(const BezierPiece& piece, int parts);
/// What is left of a piece from t_s on.
BezierPiece piece_after(const BezierPiece& piece, double t_s);

}  // namespace goshawk::guard
