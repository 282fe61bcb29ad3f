#include "corridor/ellipsoid_decomposition.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace goshawk::bench {
namespace {

struct LocalBox {
  Vec3 lower, upper;
};

std::vector<Vec3> local_points(const VoxelGrid& grid, const LocalBox& box) {
  const GridGeometry& g = grid.geometry;
  const Vec3 from = g.to_grid(box.lower), to = g.to_grid(box.upper);
  std::vector<Vec3> points;
  for (int z = int(std::floor(from.z())); z < int(std::ceil(to.z())); ++z) {
    for (int y = int(std::floor(from.y())); y < int(std::ceil(to.y())); ++y) {
      for (int x = int(std::floor(from.x())); x < int(std::ceil(to.x())); ++x) {
        if (grid.grown.test({x, y, z})) points.push_back(g.center({x, y, z}));
      }
    }
  }
  return points;
}

struct Frame {
  Eigen::Matrix3d axes;  // columns
  Vec3 center;
  Vec3 semi;
  Vec3 local(const Vec3& p) const { return axes.transpose() * (p - center); }
  double distance(const Vec3& p) const { return local(p).cwiseQuotient(semi).norm(); }
};

// Keeps the points inside the ellipsoid: it only shrinks, so that the others never matter again.
// @return the nearest of them, or nullptr
const Vec3* nearest_inside(const Frame& e, std::vector<Vec3>& points) {
  std::size_t nearest = 0, kept = 0;
  double least = 1.0 - 1e-9;
  for (const Vec3& p : points) {
    const double d = e.distance(p);
    if (d >= 1.0 - 1e-9) continue;
    if (d < least) nearest = kept;
    least = std::min(least, d);
    points[kept++] = p;
  }
  points.resize(kept);
  return kept == 0 ? nullptr : &points[nearest];
}

Frame fit(const Vec3& p, const Vec3& q, const std::vector<Vec3>& all) {
  std::vector<Vec3> points = all;
  Frame e;
  const double a = std::max(0.5 * (q - p).norm(), 1e-3);
  e.center = 0.5 * (p + q);
  e.semi = Vec3(a, a, a);
  const Vec3 u = (q - p).norm() > 1e-9 ? Vec3((q - p).normalized()) : Vec3::UnitX();
  const Vec3 v = u.unitOrthogonal();
  e.axes << u, v, u.cross(v);
  Vec3 contact = Vec3::Zero();
  while (const Vec3* at = nearest_inside(e, points)) {
    const Vec3 y = e.local(*at);
    const double b = y.tail<2>().norm() / std::sqrt(1.0 - y.x() * y.x() / (a * a));
    contact = *at - e.center - y.x() * u;
    e.semi = Vec3(a, std::max(b, 1e-6), std::max(b, 1e-6));
    if (b < 1e-6) break;
  }
  if (!(contact.norm() > 1e-9)) return e;
  const Vec3 w = contact.normalized();
  e.axes << u, w, u.cross(w);
  e.semi.z() = a;
  points = all;
  while (const Vec3* at = nearest_inside(e, points)) {
    const Vec3 y = e.local(*at).cwiseQuotient(e.semi);
    const double rest = 1.0 - y.x() * y.x() - y.y() * y.y();
    const double c = std::abs(y.z()) * e.semi.z() / std::sqrt(std::max(rest, 1e-9));
    if (!(c < e.semi.z() * (1.0 - 1e-9)) || c < e.semi.y()) break;
    e.semi.z() = c;
  }
  return e;
}

}  // namespace

Polytope decompose(const VoxelGrid& grid, const Vec3& p_map, const Vec3& q_map, double local_box_m,
                   Planes planes) {
  LocalBox box{p_map.cwiseMin(q_map).array() - local_box_m,
               p_map.cwiseMax(q_map).array() + local_box_m};
  box.lower = box.lower.cwiseMax(grid.geometry.origin_map);
  box.upper = box.upper.cwiseMin(grid.geometry.upper_corner_map());
  std::vector<Vec3> points = local_points(grid, box);
  const Frame e = fit(p_map, q_map, points);
  Polytope polytope = Polytope::box(box.lower, box.upper);
  std::vector<std::pair<double, Vec3>> rest;  // by distance
  for (const Vec3& x : points) rest.push_back({e.distance(x), x});
  while (!rest.empty()) {
    const Vec3 at =
        std::ranges::min_element(rest, {}, [](const auto& r) { return r.first; })->second;
    const Vec3 gradient = e.axes * e.local(at).cwiseQuotient(e.semi).cwiseQuotient(e.semi);
    const Vec3 n = gradient.normalized();
    const double d = n.dot(at);
    const double half_cube_m = 0.5 * grid.geometry.resolution_m * n.lpNorm<1>();
    polytope.add(n, planes == Planes::through_centres ? d : d - half_cube_m);
    std::erase_if(rest, [&](const auto& r) { return n.dot(r.second) >= d - 1e-9; });
  }
  return polytope;
}

}  // namespace goshawk::bench
