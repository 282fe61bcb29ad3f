#include "goshawk/trajectory_optimizer/knot.hpp"

namespace goshawk::trajectory_optimizer {
namespace {

// A map and its mirror image in time, which swaps the knots and the sign of odd derivatives.
PointMap first_only(double p, double v, double a) {
  return {Vec3(p, v, a), Vec3::Zero()};
}
PointMap second_only(double p, double v, double a) {
  return {Vec3::Zero(), Vec3(p, v, a)};
}

PointMap slope(const PointMap& from, const PointMap& to, double rate) {
  return {rate * (to.from_first - from.from_first), rate * (to.from_second - from.from_second)};
}

}  // namespace

PointMap position_point(int j, double T) {
  switch (j) {
    case 0:
      return first_only(1.0, 0.0, 0.0);
    case 1:
      return first_only(1.0, T / 5.0, 0.0);
    case 2:
      return first_only(1.0, 2.0 * T / 5.0, T * T / 20.0);
    case 3:
      return second_only(1.0, -2.0 * T / 5.0, T * T / 20.0);
    case 4:
      return second_only(1.0, -T / 5.0, 0.0);
    default:
      return second_only(1.0, 0.0, 0.0);
  }
}

PointMap velocity_point(int j, double T) {
  // The exact forms if the positions cancel; slope() would leave rounding behind.
  switch (j) {
    case 0:
      return first_only(0.0, 1.0, 0.0);
    case 1:
      return first_only(0.0, 1.0, T / 4.0);
    case 3:
      return second_only(0.0, 1.0, -T / 4.0);
    case 4:
      return second_only(0.0, 1.0, 0.0);
    default:
      return slope(position_point(2, T), position_point(3, T), 5.0 / T);
  }
}

PointMap acceleration_point(int j, double T) {
  if (j == 0) return first_only(0.0, 0.0, 1.0);
  if (j == 3) return second_only(0.0, 0.0, 1.0);
  return slope(velocity_point(j, T), velocity_point(j + 1, T), 4.0 / T);
}

PointMap jerk_point(int j, double T) {
  return slope(acceleration_point(j, T), acceleration_point(j + 1, T), 3.0 / T);
}

Eigen::Matrix<double, 6, 6, Eigen::DontAlign> jerk_hessian(double T) {
  Eigen::Matrix<double, 3, 6> points;
  for (int j = 0; j < 3; ++j) {
    const PointMap map = jerk_point(j, T);
    points.row(j) << map.from_first.transpose(), map.from_second.transpose();
  }
  Eigen::Matrix3d G;  // G_ij = C(2,i) C(2,j) / (5 C(4,i+j)), times 30
  G << 6.0, 3.0, 1.0, 3.0, 4.0, 3.0, 1.0, 3.0, 6.0;
  const Eigen::Matrix<double, 6, 6> Q = T / 30.0 * points.transpose() * G * points;
  return Q;
}

}  // namespace goshawk::trajectory_optimizer
