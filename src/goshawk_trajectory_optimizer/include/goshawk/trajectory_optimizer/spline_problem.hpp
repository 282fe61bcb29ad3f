#pragma once

#include <vector>

#include "goshawk/core/half_space.hpp"
#include "goshawk/core/limits.hpp"
#include "goshawk/trajectory_optimizer/knot.hpp"

namespace goshawk::trajectory_optimizer {

/// A control point of a piece, a map of one knot alone, with the faces it must stay behind:
/// faces[begin] .. faces[end - 1].
struct FacePoint {
  int knot = 0;
  Vec3 map;  // y = knot * map
  int begin = 0;
  int end = 0;
};

/// A convex problem in the knots of a spline with pieces of given durations (in units of a time
/// sigma) and, when scale is set, in eta = kappa^2 with t = kappa sigma:
///
///   minimise    time_weight * eta + jerk_weight / 2 * integral of |p'''|^2
///   subject to  control points of pieces behind their faces
///               |V_j|^2 <= v_max^2 eta,  |A_j| <= a_max eta   (euclidean: second-order cones)
///               or the same for each component              (per_axis)
///               or horizontally and vertically apart        (horizontal_vertical)
///               |J_j| <= j_max (3 eta - 1) / 2, the tangent of eta^1.5 at 1
///
/// over the inner knots; the first and the last are given, as affine functions of eta:
/// knots[0] + (eta - 1) start_rate. Without scale eta is 1. Source: the thesis' Improved
/// Minimum-Jerk section in knot states, made jointly convex in shape and time scale.
struct SplineProblem {
  bool scale = true;
  LimitNorm norm = LimitNorm::euclidean;
  double v_over_vertical = 1.0;  // horizontal_vertical: the horizontal limit over the vertical
  double a_over_vertical = 1.0;
  double time_weight = 1.0;
  double jerk_weight = 1.0;
  std::vector<double> durations;  // m
  std::vector<double> v_max;      // m, of each piece
  std::vector<double> a_max;      // m
  std::vector<double> j_max;      // m, or none: no limit on the jerk
  std::vector<Knot> knots;        // m + 1: the ends, and a guess for the others
  Knot start_rate = Knot::Zero();
  Knot goal_rate = Knot::Zero();
  std::vector<FacePoint> face_points;  // of points that are not constant
  std::vector<HalfSpace> faces;        // in the problem's unit of length

  int pieces() const { return int(durations.size()); }
  /// Keeps the capacity of every vector.
  void clear();
};

}  // namespace goshawk::trajectory_optimizer
