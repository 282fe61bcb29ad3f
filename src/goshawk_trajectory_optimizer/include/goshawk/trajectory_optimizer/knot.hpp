#pragma once

#include <Eigen/Core>

#include "goshawk/core/vector.hpp"

namespace goshawk::trajectory_optimizer {

/// Position, velocity and acceleration where two pieces meet: the columns p, v, a. With these as
/// unknowns a quintic spline is C2 whatever their values are.
using Knot = Eigen::Matrix3d;

/// A control point of a piece, or of one of its derivatives, as a linear map of the knots at the
/// two ends of the piece: y = first * from_first + second * from_second.
struct PointMap {
  Vec3 from_first = Vec3::Zero();
  Vec3 from_second = Vec3::Zero();

  Vec3 operator()(const Knot& first, const Knot& second) const {
    return first * from_first + second * from_second;
  }
};

/// @param j 0..5; T duration of the piece
PointMap position_point(int j, double T);
/// @param j 0..4
PointMap velocity_point(int j, double T);
/// @param j 0..3
PointMap acceleration_point(int j, double T);
/// @param j 0..2
PointMap jerk_point(int j, double T);

/// The integral of the squared jerk over a piece is, for each axis, x' Q x with
/// x = (p, v, a of the first knot, p, v, a of the second) (method.md, Jerk cost).
Eigen::Matrix<double, 6, 6, Eigen::DontAlign> jerk_hessian(double T);

}  // namespace goshawk::trajectory_optimizer
