#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "bezier_basis.hpp"
#include "goshawk/guard/curve.hpp"

namespace goshawk::guard {
namespace {

constexpr int kParts = 4, kFineParts = 8;  // of each piece
constexpr double kRepeated_m = 1e-6;

double farthest_between(std::span<const Vec3> points, std::size_t first, std::size_t last) {
  double most = 0.0;
  for (std::size_t i = first + 1; i < last; ++i) {
    most = std::max(most, distance_to_segment(points[i], points[first], points[last]));
  }
  return most;
}

// A late end of a segment from `first` that replaces all between: by steps of twice the length,
// then by halves. Each is looked at, so that it is right though longer ones may do again.
std::size_t farthest_end(std::span<const Vec3> points, std::size_t first, double within_m) {
  std::size_t good = first + 1, step = 1;
  const auto is_good = [&](std::size_t end) {
    return farthest_between(points, first, end) <= within_m;
  };
  while (good + step < points.size() && is_good(good + step)) {
    good += step;
    step *= 2;
  }
  for (; step > 0; step /= 2) {
    if (good + step < points.size() && is_good(good + step)) good += step;
  }
  return good;
}

}  // namespace

Status check(const Waypoints& waypoints) {
  const auto& points = waypoints.points_map;
  if (points.size() < 2 || points.size() > kMostPoints) {
    return fail(ErrorCode::invalid_input, fmt::format("the path has {} points; 2 to {} are allowed",
                                                      points.size(), kMostPoints));
  }
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (is_within_reach(points[i])) continue;
    return fail(ErrorCode::invalid_input,
                fmt::format("point {} of the path is not finite, or beyond {:g} km", i,
                            1e-3 * kFarthest_m));
  }
  const auto differs = [&](const Vec3& p) { return (p - points[0]).norm() > kRepeated_m; };
  if (std::ranges::any_of(points, differs)) return success();
  return fail(ErrorCode::invalid_input, "all points of the path are the same");
}

double deviation_from(const Trajectory& trajectory, std::span<const Vec3> polyline) {
  double most = 0.0;
  for (const BezierPiece& piece : trajectory.pieces) {
    for (const BezierPiece& part : parts_of(piece, kFineParts)) {
      double least = std::numeric_limits<double>::infinity();
      for (std::size_t i = 0; i + 1 < polyline.size(); ++i) {
        least = std::min(least, hull_distance(part, polyline[i], polyline[i + 1]));
      }
      most = std::max(most, least);
    }
  }
  return most;
}

Outline outline(const Trajectory& trajectory, double from_s) {
  Outline found;
  const Trajectory left = remainder(trajectory, from_s);
  found.points_map.push_back(left.pieces.front().control_points.col(0));
  for (const BezierPiece& piece : left.pieces) {
    for (const BezierPiece& part : parts_of(piece, kParts)) {
      const Vec3 a = part.control_points.col(0), b = part.control_points.col(5);
      const bool jumps = (a - found.points_map.back()).norm() > kRepeated_m;
      if (jumps) found.points_map.push_back(a);
      found.deviation_m = std::max(found.deviation_m, hull_distance(part, a, b));
      found.points_map.push_back(b);
    }
  }
  return found;
}

Outline simplified(std::span<const Vec3> points, double within_m) {
  Outline kept;
  kept.points_map.push_back(points.front());
  for (std::size_t first = 0; first + 1 < points.size();) {
    const std::size_t last = farthest_end(points, first, within_m);
    kept.deviation_m = std::max(kept.deviation_m, farthest_between(points, first, last));
    const bool differs = (points[last] - kept.points_map.back()).norm() > kRepeated_m;
    if (differs) kept.points_map.push_back(points[last]);
    first = last;
  }
  return kept;
}

Trajectory remainder(const Trajectory& trajectory, double t_s) {
  constexpr double kShortest_s = 1e-6;
  Trajectory left;
  double begin_s = 0.0;
  t_s = std::min(t_s, trajectory.duration_s() - 2.0 * kShortest_s);
  for (const BezierPiece& piece : trajectory.pieces) {
    const double inside_s = t_s - begin_s;
    begin_s += piece.duration_s;
    if (inside_s > piece.duration_s - kShortest_s) continue;
    left.pieces.push_back(inside_s <= 0.0 ? piece : piece_after(piece, inside_s));
  }
  return left;
}

}  // namespace goshawk::guard
