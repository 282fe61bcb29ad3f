#include "goshawk/guard/retime.hpp"

#include <algorithm>
#include <cmath>

#include "bezier_basis.hpp"

namespace goshawk::guard {
namespace {

constexpr int kMostRefinements = 4;

void add_refined(const BezierPiece& piece, const Limits& limits, int halvings, Trajectory& out) {
  if (halvings == 0 || use_of(piece, limits) <= 1.0) {
    out.pieces.push_back(piece);
    return;
  }
  for (const BezierPiece& half : parts_of(piece, 2)) add_refined(half, limits, halvings - 1, out);
}

}  // namespace

double use_of(const BezierPiece& piece, const Limits& limits) {
  double use = 0.0;
  const auto v = piece.velocity_points();
  for (int i = 0; i < 5; ++i) use = std::max(use, limits.speed_usage(v.col(i)));
  const auto a = piece.acceleration_points();
  for (int i = 0; i < 4; ++i) {
    use = std::max(use, std::sqrt(limits.acceleration_usage(a.col(i))));
  }
  if (!(limits.j_max_m_s3 > 0.0)) return use;
  const auto j = piece.jerk_points();
  for (int i = 0; i < 3; ++i) use = std::max(use, std::cbrt(j.col(i).norm() / limits.j_max_m_s3));
  return use;
}

double least_use_of(const BezierPiece& piece, const Limits& limits) {
  double use = 0.0;
  for (const double share : {0.0, 0.5, 1.0}) {
    const FlatState s = piece.sample(share * piece.duration_s);
    use = std::max({use, limits.speed_usage(s.velocity),
                    std::sqrt(limits.acceleration_usage(s.acceleration))});
    if (limits.j_max_m_s3 > 0.0) use = std::max(use, std::cbrt(s.jerk.norm() / limits.j_max_m_s3));
  }
  return use;
}

Trajectory refined(const Trajectory& trajectory, const Limits& limits) {
  Trajectory out;
  for (const BezierPiece& piece : trajectory.pieces) {
    add_refined(piece, limits, kMostRefinements, out);
  }
  return out;
}

double slowness_of(const Trajectory& trajectory, const Limits& limits) {
  double use = 1.0;
  for (const BezierPiece& piece : trajectory.pieces) use = std::max(use, use_of(piece, limits));
  return use;
}

Trajectory slower(Trajectory trajectory, double factor) {
  for (BezierPiece& piece : trajectory.pieces) piece.duration_s *= factor;
  return trajectory;
}

std::vector<Polytope> boxes_around(Trajectory& trajectory) {
  std::vector<Polytope> boxes;
  for (BezierPiece& piece : trajectory.pieces) {
    const Vec3 lower = piece.control_points.rowwise().minCoeff().array() - kBoxMargin_m;
    const Vec3 upper = piece.control_points.rowwise().maxCoeff().array() + kBoxMargin_m;
    piece.polytope = int(boxes.size());
    boxes.push_back(Polytope::box(lower, upper));
  }
  return boxes;
}

}  // namespace goshawk::guard
