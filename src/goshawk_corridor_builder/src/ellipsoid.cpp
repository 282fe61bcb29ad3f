#include "ellipsoid.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace goshawk::corridor_builder {
namespace {

constexpr double kShortestAxis = 0.05;  // [voxel edges]
constexpr double kTouching = 1.0 - 1e-9;

// z' M z over a box lo <= z <= hi by active bounds, in plain arrays: this is the inner loop.
struct BoundedMinimum {
  const double* m;  // 3 x 3, symmetric
  double lo[3], hi[3], z[3];
  unsigned free = 0;  // bit i set: coordinate i is between its bounds

  // The minimum over the free coordinates, the others held.
  void minimise_free(double* target) const {
    for (int i = 0; i < 3; ++i) target[i] = z[i];
    switch (free) {
      case 1U:
        return minimise_one(target, 0, 1, 2);
      case 2U:
        return minimise_one(target, 1, 2, 0);
      case 4U:
        return minimise_one(target, 2, 0, 1);
      case 3U:
        return minimise_two(target, 0, 1, 2);
      case 6U:
        return minimise_two(target, 1, 2, 0);
      case 5U:
        return minimise_two(target, 2, 0, 1);
      case 7U:
        target[0] = target[1] = target[2] = 0.0;
        return;
      default:
        return;
    }
  }

  void minimise_one(double* target, int i, int j, int k) const {
    target[i] = -(m[3 * i + j] * z[j] + m[3 * i + k] * z[k]) / m[3 * i + i];
  }

  void minimise_two(double* target, int i, int j, int k) const {
    const double pull_i = m[3 * i + k] * z[k];
    const double pull_j = m[3 * j + k] * z[k];
    const double det = m[3 * i + i] * m[3 * j + j] - m[3 * i + j] * m[3 * i + j];
    target[i] = (-pull_i * m[3 * j + j] + pull_j * m[3 * i + j]) / det;
    target[j] = (-pull_j * m[3 * i + i] + pull_i * m[3 * i + j]) / det;
  }

  // Moves towards target until the first bound of a free coordinate, which then is held.
  // @return false if target is reached
  bool step_to_bound(const double* target) {
    double step = 1.0;
    int blocking = -1;
    double bound = 0.0;
    for (int i = 0; i < 3; ++i) {
      if (!(free & (1U << i)) || (target[i] >= lo[i] && target[i] <= hi[i])) continue;
      const double end = target[i] < lo[i] ? lo[i] : hi[i];
      const double t = (end - z[i]) / (target[i] - z[i]);
      if (t > step) continue;
      step = t;
      blocking = i;
      bound = end;
    }
    for (int i = 0; i < 3; ++i) z[i] += step * (target[i] - z[i]);
    if (blocking < 0) return false;
    z[blocking] = bound;
    free &= ~(1U << blocking);
    return true;
  }

  // Frees the held coordinate whose bound is pulled away from hardest. @return false at the optimum
  bool release() {
    double gradient[3];
    double largest = 0.0;
    for (int i = 0; i < 3; ++i) {
      gradient[i] = m[3 * i] * z[0] + m[3 * i + 1] * z[1] + m[3 * i + 2] * z[2];
      largest = std::max(largest, std::abs(gradient[i]));
    }
    double worst = -1e-12 * largest;
    int best = -1;
    for (int i = 0; i < 3; ++i) {
      if (free & (1U << i)) continue;
      const double multiplier = z[i] == lo[i] ? gradient[i] : -gradient[i];
      if (multiplier >= worst) continue;
      worst = multiplier;
      best = i;
    }
    if (best < 0) return false;
    free |= 1U << best;
    return true;
  }
};

struct Frame {
  Vec3 u1, u2, u3;  // orthonormal
};

Mat3 metric_of(const Frame& f, double a, double b, double c) {
  return f.u1 * f.u1.transpose() / (a * a) + f.u2 * f.u2.transpose() / (b * b) +
         f.u3 * f.u3.transpose() / (c * c);
}

Frame frame_along(const Vec3& direction) {
  Frame f;
  f.u1 = direction;
  int least = 0;
  f.u1.cwiseAbs().minCoeff(&least);
  f.u2 = (Vec3::Unit(least) - f.u1[least] * f.u1).normalized();
  f.u3 = f.u1.cross(f.u2);
  return f;
}

bool meets_sphere(const Vec3& lower, const Vec3& upper, const Vec3& center, double radius) {
  const Vec3 nearest = center.cwiseMax(lower).cwiseMin(upper);
  return (nearest - center).squaredNorm() < radius * radius;
}

// Shortens one semi-axis pair of the spheroid until no box is inside. For one box the critical
// length is the minimum over its points of rho / sqrt(1 - (x/a)^2), a ratio of convex functions:
// Dinkelbach's iteration, from above.
double shrink_sides(const Frame& f, double a, const Vec3& center, const BoxSet& boxes,
                    Vec3& contact) {
  double b = a;
  Ellipsoid e{center, metric_of(f, a, b, b)};
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    const Vec3 lower = boxes.lower(i), upper = boxes.upper(i);
    if (!meets_sphere(lower, upper, center, a)) continue;
    if (squared_at_least(e, lower, upper) >= kTouching) continue;
    for (int k = 0; k < 12 && b > kShortestAxis; ++k) {
      const Nearest at = nearest_in_box(e, lower, upper);
      if (at.squared >= kTouching) break;
      const double x = f.u1.dot(at.offset);
      const double rest = std::max(1.0 - x * x / (a * a), 1e-12);
      contact = at.offset - x * f.u1;
      b = std::clamp(contact.norm() / std::sqrt(rest), kShortestAxis, b);
      e.metric = metric_of(f, a, b, b);
    }
  }
  return b;
}

double shrink_third(const Frame& f, double a, double b, const Vec3& center, const BoxSet& boxes) {
  double c = a;
  Ellipsoid e{center, metric_of(f, a, b, c)};
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    const Vec3 lower = boxes.lower(i), upper = boxes.upper(i);
    if (!meets_sphere(lower, upper, center, a)) continue;
    if (squared_at_least(e, lower, upper) >= kTouching) continue;
    for (int k = 0; k < 12 && c > b; ++k) {
      const Nearest at = nearest_in_box(e, lower, upper);
      if (at.squared >= kTouching) break;
      const double x = f.u1.dot(at.offset) / a;
      const double y = f.u2.dot(at.offset) / b;
      const double rest = std::max(1.0 - x * x - y * y, 1e-12);
      c = std::clamp(std::abs(f.u3.dot(at.offset)) / std::sqrt(rest), b, c);
      e.metric = metric_of(f, a, b, c);
    }
  }
  return c;
}

}  // namespace

double squared_at_least(const Ellipsoid& ellipsoid, const Vec3& lower, const Vec3& upper) {
  const double* m = ellipsoid.metric.data();
  double lo[3], hi[3], z[3];
  for (int i = 0; i < 3; ++i) {
    lo[i] = lower[i] - ellipsoid.center[i];
    hi[i] = upper[i] - ellipsoid.center[i];
    z[i] = std::min(std::max(0.0, lo[i]), hi[i]);
  }
  double bound = 0.0;
  for (int i = 0; i < 3; ++i) {
    const double g = m[3 * i] * z[0] + m[3 * i + 1] * z[1] + m[3 * i + 2] * z[2];
    bound += g * (2.0 * (g > 0.0 ? lo[i] : hi[i]) - z[i]);
  }
  return std::max(0.0, bound);
}

Nearest nearest_in_box(const Ellipsoid& ellipsoid, const Vec3& lower, const Vec3& upper) {
  BoundedMinimum at;
  at.m = ellipsoid.metric.data();
  for (int i = 0; i < 3; ++i) {
    at.lo[i] = lower[i] - ellipsoid.center[i];
    at.hi[i] = upper[i] - ellipsoid.center[i];
    at.z[i] = std::min(std::max(0.0, at.lo[i]), at.hi[i]);
    at.free |= (at.lo[i] < 0.0 && at.hi[i] > 0.0) ? 1U << i : 0U;
  }
  for (int iteration = 0; iteration < 16; ++iteration) {
    double target[3];
    at.minimise_free(target);
    if (!at.step_to_bound(target) && !at.release()) break;
  }
  const Vec3 z(at.z[0], at.z[1], at.z[2]);
  return {z, z.dot(ellipsoid.metric * z)};
}

Ellipsoid shrink_around_segment(const Vec3& p, const Vec3& q, const BoxSet& boxes) {
  const double length = (q - p).norm();
  const Vec3 center = 0.5 * (p + q);
  const double a = 0.5 * length;
  if (a <= kShortestAxis) {
    return {center, Mat3::Identity() / (kShortestAxis * kShortestAxis)};
  }
  Frame f = frame_along((q - p) / length);
  Vec3 contact = Vec3::Zero();
  const double b = shrink_sides(f, a, center, boxes, contact);
  if (contact.norm() < 1e-9) return {center, metric_of(f, a, b, b)};
  f.u2 = contact.normalized();
  f.u3 = f.u1.cross(f.u2);
  const double c = shrink_third(f, a, b, center, boxes);
  return {center, metric_of(f, a, b, c)};
}

}  // namespace goshawk::corridor_builder
