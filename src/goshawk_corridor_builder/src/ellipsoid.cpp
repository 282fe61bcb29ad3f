#include "ellipsoid.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace goshawk::corridor_builder {
namespace {

constexpr double kShortestAxis = 0.05;  // [voxel edges]
constexpr double kTouching = 1.0 - 1e-9;

// Minimises z' M z over the coordinates that are free (bit set in `free`), the others held.
Vec3 minimise_free(const Mat3& m, const Vec3& z, unsigned free) {
  Vec3 result = z;
  const Vec3 held((free & 1U) ? 0.0 : z[0], (free & 2U) ? 0.0 : z[1], (free & 4U) ? 0.0 : z[2]);
  const Vec3 pull = m * held;
  int axes[3];
  int n = 0;
  for (int i = 0; i < 3; ++i) {
    if (free & (1U << i)) axes[n++] = i;
  }
  if (n == 3) return Vec3::Zero();
  if (n == 1) result[axes[0]] = -pull[axes[0]] / m(axes[0], axes[0]);
  if (n == 2) {
    const int i = axes[0];
    const int j = axes[1];
    const double det = m(i, i) * m(j, j) - m(i, j) * m(i, j);
    result[i] = (-pull[i] * m(j, j) + pull[j] * m(i, j)) / det;
    result[j] = (-pull[j] * m(i, i) + pull[i] * m(i, j)) / det;
  }
  return result;
}

// Moves from z towards target until the first bound of a free coordinate.
// @return that coordinate, or -1 where target is reached
int step_to_bound(Vec3& z, const Vec3& target, const Vec3& lo, const Vec3& hi, unsigned free) {
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
  z += step * (target - z);
  if (blocking >= 0) z[blocking] = bound;
  return blocking;
}

// The held coordinate whose bound is pulled away from hardest, or -1 at the optimum.
int coordinate_to_release(const Mat3& m, const Vec3& z, const Vec3& lo, unsigned free) {
  const Vec3 gradient = m * z;
  double worst = -1e-12 * gradient.cwiseAbs().maxCoeff();
  int release = -1;
  for (int i = 0; i < 3; ++i) {
    if (free & (1U << i)) continue;
    const double multiplier = z[i] == lo[i] ? gradient[i] : -gradient[i];
    if (multiplier >= worst) continue;
    worst = multiplier;
    release = i;
  }
  return release;
}

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
    if (!meets_sphere(boxes.lower(i), boxes.upper(i), center, a)) continue;
    for (int k = 0; k < 12 && b > kShortestAxis; ++k) {
      const Nearest at = nearest_in_box(e, boxes.lower(i), boxes.upper(i));
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
    if (!meets_sphere(boxes.lower(i), boxes.upper(i), center, a)) continue;
    for (int k = 0; k < 12 && c > b; ++k) {
      const Nearest at = nearest_in_box(e, boxes.lower(i), boxes.upper(i));
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

Nearest nearest_in_box(const Ellipsoid& ellipsoid, const Vec3& lower, const Vec3& upper) {
  const Mat3& m = ellipsoid.metric;
  const Vec3 lo = lower - ellipsoid.center;
  const Vec3 hi = upper - ellipsoid.center;
  Vec3 z = Vec3::Zero().cwiseMax(lo).cwiseMin(hi);
  unsigned free = 0;
  for (int i = 0; i < 3; ++i) free |= (lo[i] < 0.0 && hi[i] > 0.0) ? 1U << i : 0U;
  for (int iteration = 0; iteration < 16; ++iteration) {
    const int blocking = step_to_bound(z, minimise_free(m, z, free), lo, hi, free);
    if (blocking >= 0) {
      free &= ~(1U << blocking);
      continue;
    }
    const int release = coordinate_to_release(m, z, lo, free);
    if (release < 0) break;
    free |= 1U << release;
  }
  return {z, z.dot(m * z)};
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
