#include "bezier_basis.hpp"

#include <algorithm>
#include <cmath>

#include "goshawk/guard/curve.hpp"

namespace goshawk::guard {

bool is_within_reach(const Vec3& p_map) {
  return p_map.allFinite() && p_map.cwiseAbs().maxCoeff() <= kFarthest_m;
}

std::vector<Vec3> raised(std::span<const Vec3> points) {
  const double n = double(points.size());
  std::vector<Vec3> more(points.size() + 1);
  more.front() = points.front();
  more.back() = points.back();
  for (std::size_t i = 1; i < points.size(); ++i) {
    const double share = double(i) / n;
    more[i] = share * points[i - 1] + (1.0 - share) * points[i];
  }
  return more;
}

BezierPiece quintic(std::vector<Vec3> points, double duration_s) {
  while (points.size() < 6) points = raised(points);
  BezierPiece piece;
  piece.duration_s = duration_s;
  for (int i = 0; i < 6; ++i) piece.control_points.col(i) = points[std::size_t(i)];
  return piece;
}

Halves halved(std::span<const Vec3> points) {
  std::vector<Vec3> level(points.begin(), points.end());
  Halves halves;
  halves.second.resize(points.size());
  for (std::size_t last = points.size(); last-- > 0;) {
    halves.first.push_back(level.front());
    halves.second[last] = level[last];
    for (std::size_t i = 0; i < last; ++i) level[i] = 0.5 * (level[i] + level[i + 1]);
  }
  return halves;
}

std::vector<double> bernstein(std::span<const double> coefficients, double duration_s, int degree) {
  const auto choose = [](int n, int k) {
    double product = 1.0;
    for (int i = 1; i <= k; ++i) product *= double(n - k + i) / i;
    return product;
  };
  std::vector<double> points(std::size_t(degree) + 1, 0.0);
  double power = 1.0;
  for (int j = 0; j < int(coefficients.size()); ++j) {
    const double scaled = coefficients[std::size_t(j)] * power / choose(degree, j);
    for (int i = j; i <= degree; ++i) points[std::size_t(i)] += choose(i, j) * scaled;
    power *= duration_s;
  }
  return points;
}

double distance_to_segment(const Vec3& p, const Vec3& a, const Vec3& b) {
  const Vec3 along = b - a;
  const double squared = along.squaredNorm();
  const double share = squared > 0.0 ? std::clamp((p - a).dot(along) / squared, 0.0, 1.0) : 0.0;
  return (p - a - share * along).norm();
}

double hull_distance(const BezierPiece& piece, const Vec3& a, const Vec3& b) {
  double most = 0.0;
  for (int i = 0; i < 6; ++i) {
    most = std::max(most, distance_to_segment(piece.control_points.col(i), a, b));
  }
  return most;
}

BezierPiece piece_after(const BezierPiece& piece, double t_s) {
  BezierPiece back = piece;
  back.control_points = piece.control_points.rowwise().reverse().eval();
  back = back.until(piece.duration_s - t_s);
  back.control_points = back.control_points.rowwise().reverse().eval();
  return back;
}

std::vector<BezierPiece> parts_of(const BezierPiece& piece, int parts) {
  std::vector<BezierPiece> found;
  BezierPiece left = piece;
  for (int i = parts; i > 1; --i) {
    const double step_s = left.duration_s / i;
    found.push_back(left.until(step_s));
    left = piece_after(left, step_s);
  }
  found.push_back(left);
  return found;
}

}  // namespace goshawk::guard
