#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>

namespace goshawk::trajectory_optimizer {

/// One second-order cone constraint {s : s_0 >= |s_1..|} of the interior-point method, with its
/// slack s, multiplier z and Nesterov-Todd scaling W (Vandenberghe, "The CVXOPT linear and
/// quadratic cone program solvers", 2010, sections 3 and 4). The slack is an affine map of a point
/// y of D components and the squared time scale eta:
///   plain    |y| <= limit * eta       as  s = (eta, y / limit)
///   Rotated  |y|^2 <= limit^2 * eta   as  s = (eta + 1, 2 y / limit, eta - 1)
template <int D, bool Rotated>
struct LimitCone {
  static constexpr int N = 1 + D + (Rotated ? 1 : 0);
  using Vector = Eigen::Matrix<double, N, 1>;
  using Point = Eigen::Matrix<double, D, 1>;

  /// What the constraint adds to the reduced Hessian: of y y, y eta and eta eta.
  struct Curvature {
    double along = 0.0;  // yy = diagonal * I + along * direction * direction'
    double diagonal = 0.0;
    Point direction;
    Point mixed;
    double eta = 0.0;
  };
  /// A gradient: of y and of eta.
  struct Slope {
    Point y;
    double eta = 0.0;
  };

  double gain = 1.0;  // 1 / limit, or 2 / limit when Rotated
  Vector s, z;
  Vector residual;   // s minus the slack that y and eta ask for
  Vector lambda;     // W z = W^-1 s
  Vector scaled_dz;  // W dz of the predictor
  Vector ds, dz;

  void set_limit(double limit) { gain = (Rotated ? 2.0 : 1.0) / limit; }

  Vector slack(const Point& y, double eta) const {
    Vector v = direction_of(y, eta);
    if constexpr (Rotated) {
      v[0] += 1.0;
      v[N - 1] -= 1.0;
    }
    return v;
  }
  Vector direction_of(const Point& dy, double deta) const {
    Vector v;
    v[0] = deta;
    v.template segment<D>(1) = gain * dy;
    if constexpr (Rotated) v[N - 1] = deta;
    return v;
  }
  Slope transposed(const Vector& v) const {
    return {gain * v.template segment<D>(1), Rotated ? v[0] + v[N - 1] : v[0]};
  }

  /// A slack inside the cone near the one asked for, and the multiplier that centres it.
  void start(const Vector& wanted, double margin, double mu) {
    s = wanted;
    s[0] = std::max(s[0], s.template tail<N - 1>().norm() + margin);
    const double det = determinant(s);
    z = -mu / det * s;
    z[0] = -z[0];
  }

  /// @return false where rounding has pushed s or z out of the cone
  bool update_scaling() {
    const double det_s = determinant(s);
    const double det_z = determinant(z);
    if (!(det_s > 0.0 && det_z > 0.0 && s[0] > 0.0 && z[0] > 0.0)) return false;
    const double size_s = std::sqrt(det_s);
    const double size_z = std::sqrt(det_z);
    const double gamma = std::sqrt(0.5 * (1.0 + s.dot(z) / (size_s * size_z)));
    mirror_w_ = (0.5 / (gamma * size_s)) * s;
    mirror_w_.template tail<N - 1>() *= -1.0;
    mirror_w_ += (0.5 / (gamma * size_z)) * z;
    beta2_ = size_s / size_z;
    beta_ = std::sqrt(beta2_);
    root_ = mirror_w_;
    root_.template tail<N - 1>() *= -1.0;
    root_[0] += 1.0;
    root_ /= std::sqrt(2.0 * root_[0]);
    lambda = scale(z);
    return true;
  }

  Curvature curvature() const {
    const auto u = mirror_w_.template segment<D>(1);
    const double e = Rotated ? mirror_w_[0] + mirror_w_[N - 1] : mirror_w_[0];
    const double inverse = 1.0 / beta2_;
    Curvature c;
    c.diagonal = gain * gain * inverse;
    c.along = 2.0 * c.diagonal;
    c.direction = u;
    c.mixed = (2.0 * gain * e * inverse) * u;
    c.eta = inverse * (2.0 * e * e - (Rotated ? 0.0 : 1.0));
    return c;
  }

  /// W v and W^-2 v
  Vector scale(const Vector& v) const {
    Vector r = (2.0 * root_.dot(v)) * root_ + v;
    r[0] -= 2.0 * v[0];
    return beta_ * r;
  }
  Vector unscale_twice(const Vector& v) const {
    Vector r = (2.0 * mirror_w_.dot(v)) * mirror_w_ + v;
    r[0] -= 2.0 * v[0];
    return r / beta2_;
  }

  /// The x with lambda o x = b, o the Jordan product.
  Vector divide_by_lambda(const Vector& b) const {
    const auto l1 = lambda.template tail<N - 1>();
    const auto b1 = b.template tail<N - 1>();
    Vector x;
    x[0] = (lambda[0] * b[0] - l1.dot(b1)) / determinant(lambda);
    x.template tail<N - 1>() = (b1 - x[0] * l1) / lambda[0];
    return x;
  }
  static Vector jordan(const Vector& a, const Vector& b) {
    Vector r = a[0] * b + b[0] * a;
    r[0] = a.dot(b);
    return r;
  }

  /// @return the largest step with v + step * d in the cone. @pre v inside the cone
  static double step_to_boundary(const Vector& v, const Vector& d) {
    const double a = determinant(d);
    const double b = v[0] * d[0] - v.template tail<N - 1>().dot(d.template tail<N - 1>());
    const double c = determinant(v);
    const double under_root = b * b - a * c;
    const double denominator = under_root > 0.0 ? std::sqrt(under_root) - b : -b;
    if (!(denominator > 0.0) || under_root < 0.0) return std::numeric_limits<double>::infinity();
    return c / denominator;
  }
  double step_to_boundary() const {
    return std::min(step_to_boundary(s, ds), step_to_boundary(z, dz));
  }

  static double determinant(const Vector& v) {
    const double length = v.template tail<N - 1>().norm();
    return (v[0] - length) * (v[0] + length);
  }

 private:
  Vector mirror_w_;  // J w, W^2 = beta^2 (2 w w' - J)
  Vector root_;      // W = beta (2 root root' - J)
  double beta_ = 1.0;
  double beta2_ = 1.0;
};

}  // namespace goshawk::trajectory_optimizer
