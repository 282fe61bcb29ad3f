#include "goshawk/navigator/way_out.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <vector>

#include "goshawk/core/free_curve.hpp"

namespace goshawk::navigator {
namespace {

constexpr std::size_t kMostEnds = 400;  // the nearest ones; each is looked at
constexpr double kTube_m = 1e-3;        // half the width of the polytope around the way

/// The centres of voxels that are free for planning, the nearest first.
std::vector<Vec3> free_centres(const VoxelGrid& grid, const Vec3& rest_map) {
  const GridGeometry& g = grid.geometry;
  const Vec3 low = g.to_grid(rest_map - Vec3::Constant(kWayOut_m));
  const Vec3 high = g.to_grid(rest_map + Vec3::Constant(kWayOut_m));
  const auto from = [&](int axis) { return int(std::max(0.0, std::floor(low[axis]))); };
  const auto to = [&](int axis, int n) { return int(std::min(n - 1.0, std::floor(high[axis]))); };
  std::vector<Vec3> centres;
  for (int z = from(2); z <= to(2, g.size.z); ++z) {
    for (int y = from(1); y <= to(1, g.size.y); ++y) {
      for (int x = from(0); x <= to(0, g.size.x); ++x) {
        if (!grid.grown.get({x, y, z})) centres.push_back(g.center({x, y, z}));
      }
    }
  }
  const auto distance = [&](const Vec3& p) { return (p - rest_map).squaredNorm(); };
  std::ranges::stable_sort(centres, {}, distance);
  if (centres.size() > kMostEnds) centres.resize(kMostEnds);
  return centres;
}

/// How long a rest-to-rest quintic takes whose control points keep the limits on every axis.
double duration_s(double length_m, const Limits& limits) {
  const double v = limits.v_max_vertical_m_s > 0.0
                       ? std::min(limits.v_max_m_s, limits.v_max_vertical_m_s)
                       : limits.v_max_m_s;
  const double a = limits.a_max_vertical_m_s2 > 0.0
                       ? std::min(limits.a_max_m_s2, limits.a_max_vertical_m_s2)
                       : limits.a_max_m_s2;
  const double j = limits.j_max_m_s3;
  return 1.001 * std::max({5.0 * length_m / v, std::sqrt(20.0 * length_m / a),
                           j > 0.0 ? std::cbrt(120.0 * length_m / j) : 0.0});
}

Polytope tube(const Vec3& from, const Vec3& to) {
  const Vec3 along = (to - from).normalized();
  const Vec3 side = along.unitOrthogonal(), up = along.cross(side);
  Polytope polytope;
  polytope.add(along, along.dot(to) + kTube_m);
  polytope.add(-along, -along.dot(from) + kTube_m);
  for (const Vec3& normal : {side, Vec3(-side), up, Vec3(-up)}) {
    polytope.add(normal, normal.dot(from) + kTube_m);
  }
  return polytope;
}

}  // namespace

Result<CertifiedTrajectory> way_out(const Vec3& rest_map, const FreeSpace& space,
                                    const Limits& limits) {
  const FlatState rest{.position = rest_map};
  for (const Vec3& centre : free_centres(*space.grid(), rest_map)) {
    const double length_m = (centre - rest_map).norm();
    if (!(length_m > 0.0)) continue;
    const FlatState end{.position = centre};
    Trajectory way{{BezierPiece::between(rest, end, duration_s(length_m, limits))}};
    if (find_obstruction(space, way)) continue;
    return certify(std::move(way), {tube(rest_map, centre)}, limits, rest, end);
  }
  return fail(ErrorCode::start_occupied,
              fmt::format("there is no straight way out from {} to free space within {:.3g} m that "
                          "comes no nearer to an obstacle",
                          to_text(rest_map), kWayOut_m));
}

}  // namespace goshawk::navigator
