#include "inscribed_ellipsoid.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

namespace goshawk::corridor_builder {
namespace {

constexpr int kSteps = 8;
constexpr double kFirstWeight = 1.0;
constexpr double kLastWeight = 0.02;

using Vec9 = Eigen::Matrix<double, 9, 1>;
using Mat9 = Eigen::Matrix<double, 9, 9>;

// Unknowns: c (0..2), the columns of the lower triangle L: (3, 4, 5), (6, 7), (8).
struct Shape {
  Vec9 x;

  auto c() const { return x.head<3>(); }
  Vec3 stretch(const Vec3& n) const {  // L' n
    return {x[3] * n[0] + x[4] * n[1] + x[5] * n[2], x[6] * n[1] + x[7] * n[2], x[8] * n[2]};
  }
  double least_axis() const { return std::min({x[3], x[6], x[8]}); }
  double determinant() const { return x[3] * x[6] * x[8]; }
};

// The cone of one plane: t^2 - |u|^2 > 0 with t > 0.
struct Cone {
  double t;
  Vec3 u;
  double value() const { return t * t - u.squaredNorm(); }
  bool inside() const { return t > 0.0 && value() > 0.0; }
};

Cone cone_of(const Shape& s, const Plane& plane) {
  return {plane.offset - plane.normal.dot(s.c()), s.stretch(plane.normal)};
}

// Minus the objective; infinite where infeasible.
double merit(const Shape& s, std::span<const Plane> planes, double weight) {
  if (!(s.least_axis() > 0.0)) return std::numeric_limits<double>::infinity();
  double product = 1.0;
  double barrier = 0.0;
  for (const Plane& plane : planes) {
    const Cone cone = cone_of(s, plane);
    if (!cone.inside()) return std::numeric_limits<double>::infinity();
    product *= cone.value();
    if (product < 1e-100 || product > 1e100) {
      barrier += std::log(product);
      product = 1.0;
    }
  }
  return -std::log(s.determinant()) - weight * (barrier + std::log(product));
}

void add_cone(const Cone& cone, const Vec3& n, double weight, Vec9& gradient, Mat9& hessian) {
  const double value = cone.value();
  Vec9 g;  // half the gradient of the cone's value
  g << -cone.t * n, -cone.u[0] * n, -cone.u[1] * n.tail<2>(), -cone.u[2] * n[2];
  gradient -= (2.0 * weight / value) * g;
  hessian.noalias() += (4.0 * weight / (value * value)) * g * g.transpose();
  const double k = 2.0 * weight / value;
  const Mat3 outer = k * n * n.transpose();
  hessian.block<3, 3>(0, 0) -= outer;
  hessian.block<3, 3>(3, 3) += outer;
  hessian.block<2, 2>(6, 6) += outer.bottomRightCorner<2, 2>();
  hessian(8, 8) += outer(2, 2);
}

// One damped Newton step. @return false where no step helps
bool newton_step(Shape& s, std::span<const Plane> planes, double weight) {
  Vec9 gradient = Vec9::Zero();
  Mat9 hessian = Mat9::Zero();
  for (const int i : {3, 6, 8}) {
    gradient[i] -= 1.0 / s.x[i];
    hessian(i, i) += 1.0 / (s.x[i] * s.x[i]);
  }
  for (const Plane& plane : planes) {
    add_cone(cone_of(s, plane), plane.normal, weight, gradient, hessian);
  }
  const Vec9 step = -hessian.llt().solve(gradient);
  const double slope = gradient.dot(step);
  if (!step.allFinite() || !(slope < 0.0)) return false;
  const double before = merit(s, planes, weight);
  for (double length = 1.0; length > 1e-4; length *= 0.5) {
    const Shape next{s.x + length * step};
    if (merit(next, planes, weight) <= before + 0.1 * length * slope) {
      s = next;
      return true;
    }
  }
  return false;
}

bool start_inside(std::span<const Plane> planes, const Ellipsoid& inside, Shape& s) {
  const Mat3 lower = Mat3(inside.metric.inverse()).llt().matrixL();
  s.x << inside.center, lower(0, 0), lower(1, 0), lower(2, 0), lower(1, 1), lower(2, 1),
      lower(2, 2);
  s.x.tail<6>() *= 0.9;
  auto feasible = [&] {
    return std::all_of(planes.begin(), planes.end(),
                       [&](const Plane& plane) { return cone_of(s, plane).inside(); });
  };
  for (int k = 0; k < 20; ++k) {
    if (feasible()) return true;
    s.x.tail<6>() *= 0.5;
  }
  return false;
}

}  // namespace

bool grow_inscribed_ellipsoid(std::span<const Plane> planes, const Ellipsoid& inside,
                              Ellipsoid& grown) {
  Shape s;
  if (!start_inside(planes, inside, s)) return false;
  double weight = kFirstWeight;
  for (int k = 0; k < kSteps; ++k) {
    if (!newton_step(s, planes, weight) && weight <= kLastWeight) break;
    weight = std::max(kLastWeight, 0.4 * weight);
  }
  Mat3 lower;
  lower << s.x[3], 0, 0, s.x[4], s.x[6], 0, s.x[5], s.x[7], s.x[8];
  const Mat3 inverse = lower.inverse();
  grown = {s.c(), inverse.transpose() * inverse};
  return grown.metric.allFinite();
}

}  // namespace goshawk::corridor_builder
