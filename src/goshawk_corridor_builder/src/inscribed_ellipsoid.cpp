#include "inscribed_ellipsoid.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

namespace goshawk::corridor_builder {
namespace {

// Of the barrier. The first stays while an ellipsoid that began small still doubles; one step with
// the last follows. Measured: that is two to three steps, and makes larger polytopes than eight
// steps down to 0.02. What is not pressed against the planes yet is rounder, and the planes that it
// makes next stand farther away.
constexpr double kFirstWeight = 1.0;
constexpr double kLastWeight = 0.3;
constexpr int kMostFirstSteps = 6;

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

// The barrier's two parts, to be weighted: infinite if infeasible.
struct Merit {
  double shape = std::numeric_limits<double>::infinity();  // -log det L
  double cones = 0.0;                                      // -sum of log(cone values)

  double at(double weight) const { return shape + weight * cones; }
};

Merit merit(const Shape& s, std::span<const Plane> planes) {
  if (!(s.least_axis() > 0.0)) return {};
  double product = 1.0;
  double sum = 0.0;
  for (const Plane& plane : planes) {
    const Cone cone = cone_of(s, plane);
    if (!cone.inside()) return {};
    product *= cone.value();
    if (product < 1e-100 || product > 1e100) {
      sum += std::log(product);
      product = 1.0;
    }
  }
  return {-std::log(s.determinant()), -(sum + std::log(product))};
}

// Adds to the lower triangle of the Hessian.
void add_cone(const Cone& cone, const Vec3& n, double weight, Vec9& gradient, Mat9& hessian) {
  const double value = cone.value();
  const double k = 2.0 * weight / value;
  const double* v = n.data();
  const double* u = cone.u.data();
  // Half the gradient of the cone's value.
  const double g[9] = {-cone.t * v[0], -cone.t * v[1], -cone.t * v[2], -u[0] * v[0], -u[0] * v[1],
                       -u[0] * v[2],   -u[1] * v[1],   -u[1] * v[2],   -u[2] * v[2]};
  const double scale = 4.0 * weight / (value * value);
  double* h = hessian.data();
  for (int j = 0; j < 9; ++j) {
    gradient[j] -= k * g[j];
    const double f = scale * g[j];
    for (int i = j; i < 9; ++i) h[9 * j + i] += f * g[i];
  }
  for (int j = 0; j < 3; ++j) {
    const double f = k * v[j];
    for (int i = j; i < 3; ++i) {
      h[9 * j + i] -= f * v[i];
      h[9 * (3 + j) + 3 + i] += f * v[i];
      if (j > 0) h[9 * (5 + j) + 5 + i] += f * v[i];
    }
  }
  h[9 * 8 + 8] += k * v[2] * v[2];
}

// Solves H x = -g by Cholesky's method on the lower triangle. @return false if H is not
// positive definite
bool solve_newton(Mat9& hessian, const Vec9& gradient, Vec9& x) {
  double* h = hessian.data();
  for (int j = 0; j < 9; ++j) {
    double* column = h + 9 * j;
    if (!(column[j] > 0.0)) return false;
    const double inverse = 1.0 / std::sqrt(column[j]);
    for (int i = j; i < 9; ++i) column[i] *= inverse;
    for (int k = j + 1; k < 9; ++k) {
      const double f = column[k];
      for (int i = k; i < 9; ++i) h[9 * k + i] -= f * column[i];
    }
  }
  for (int j = 0; j < 9; ++j) x[j] = -gradient[j];
  for (int j = 0; j < 9; ++j) {
    x[j] /= h[9 * j + j];
    for (int i = j + 1; i < 9; ++i) x[i] -= h[9 * j + i] * x[j];
  }
  for (int j = 8; j >= 0; --j) {
    for (int i = j + 1; i < 9; ++i) x[j] -= h[9 * j + i] * x[i];
    x[j] /= h[9 * j + j];
  }
  return true;
}

// One damped Newton step, if one helps.
void newton_step(Shape& s, Merit& here, std::span<const Plane> planes, double weight) {
  Vec9 gradient = Vec9::Zero();
  Mat9 hessian = Mat9::Zero();
  for (const int i : {3, 6, 8}) {
    gradient[i] -= 1.0 / s.x[i];
    hessian(i, i) += 1.0 / (s.x[i] * s.x[i]);
  }
  for (const Plane& plane : planes) {
    add_cone(cone_of(s, plane), plane.normal, weight, gradient, hessian);
  }
  Vec9 step;
  if (!solve_newton(hessian, gradient, step)) return;
  const double slope = gradient.dot(step);
  if (!step.allFinite() || !(slope < 0.0)) return;
  const double before = here.at(weight);
  for (double length = 1.0; length > 1e-4; length *= 0.5) {
    const Shape next{s.x + length * step};
    const Merit there = merit(next, planes);
    if (there.at(weight) <= before + 0.1 * length * slope) {
      s = next;
      here = there;
      return;
    }
  }
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
  Merit here = merit(s, planes);
  for (int k = 0; k < kMostFirstSteps; ++k) {
    const double before = s.determinant();
    newton_step(s, here, planes, kFirstWeight);
    if (s.determinant() < 2.0 * before) break;
  }
  newton_step(s, here, planes, kLastWeight);
  Mat3 lower;
  lower << s.x[3], 0, 0, s.x[4], s.x[6], 0, s.x[5], s.x[7], s.x[8];
  const Mat3 inverse = lower.inverse();
  grown = {s.c(), inverse.transpose() * inverse};
  return grown.metric.allFinite();
}

}  // namespace goshawk::corridor_builder
