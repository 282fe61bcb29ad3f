// The distance between a polytope and a box, from nothing but their corners.

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "corridor_checker.hpp"

namespace goshawk::corridor_builder::test_support {
namespace {

struct Edge {
  Vec3 a, b;
};

Vec3 corner(unsigned i, const Vec3& lower, const Vec3& upper) {
  return {(i & 1U) ? upper.x() : lower.x(), (i & 2U) ? upper.y() : lower.y(),
          (i & 4U) ? upper.z() : lower.z()};
}

// Two corners that lie on two common faces are joined by an edge (or lie on one).
std::vector<Edge> edges_of(const Polytope& polytope, const std::vector<Vec3>& vertices) {
  std::vector<Edge> edges;
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    for (std::size_t j = i + 1; j < vertices.size(); ++j) {
      int common = 0;
      for (int k = 0; k < polytope.faces(); ++k) {
        const Vec3 n = polytope.A().row(k);
        common += std::abs(n.dot(vertices[i]) - polytope.b()[k]) < 1e-8 &&
                  std::abs(n.dot(vertices[j]) - polytope.b()[k]) < 1e-8;
      }
      if (common >= 2) edges.push_back({vertices[i], vertices[j]});
    }
  }
  return edges;
}

std::vector<Edge> edges_of_box(const Vec3& lower, const Vec3& upper) {
  std::vector<Edge> edges;
  for (unsigned i = 0; i < 8; ++i) {
    for (const unsigned axis : {1U, 2U, 4U}) {
      if (!(i & axis)) edges.push_back({corner(i, lower, upper), corner(i | axis, lower, upper)});
    }
  }
  return edges;
}

double edge_distance(const Edge& e, const Edge& f) {
  const Vec3 d = e.b - e.a, g = f.b - f.a, r = e.a - f.a;
  const double a = d.dot(d), c = g.dot(g), b = d.dot(g);
  const double det = a * c - b * b;
  if (!(det > 1e-12 * a * c)) return std::numeric_limits<double>::infinity();  // ends are tried
  const double s = (b * g.dot(r) - c * d.dot(r)) / det;
  const double t = (a * g.dot(r) - b * d.dot(r)) / det;
  if (s < 0.0 || s > 1.0 || t < 0.0 || t > 1.0) return std::numeric_limits<double>::infinity();
  return (r + s * d - t * g).norm();
}

double point_to_edge(const Vec3& p, const Edge& e) {
  const Vec3 d = e.b - e.a;
  const double length = d.squaredNorm();
  const double t = length > 0.0 ? std::clamp(d.dot(p - e.a) / length, 0.0, 1.0) : 0.0;
  return (e.a + t * d - p).norm();
}

double point_to_polytope(const Vec3& p, const Polytope& polytope, const std::vector<Edge>& edges) {
  if (polytope.violation(p) <= 0.0) return 0.0;
  double least = std::numeric_limits<double>::infinity();
  for (int k = 0; k < polytope.faces(); ++k) {
    const Vec3 n = polytope.A().row(k);
    const double height = n.dot(p) - polytope.b()[k];
    if (height > 0.0 && polytope.violation(p - height * n) < 1e-9) least = std::min(least, height);
  }
  for (const Edge& e : edges) least = std::min(least, point_to_edge(p, e));
  return least;
}

}  // namespace

double distance_to_box(const Polytope& polytope, const Vec3& lower, const Vec3& upper) {
  if (interiors_meet(polytope, lower, upper)) return 0.0;
  const std::vector<Vec3> vertices = vertices_of(polytope);
  const std::vector<Edge> edges = edges_of(polytope, vertices);
  double least = std::numeric_limits<double>::infinity();
  for (const Vec3& v : vertices) {
    least = std::min(least, (v.cwiseMax(lower).cwiseMin(upper) - v).norm());
  }
  for (unsigned i = 0; i < 8; ++i) {
    least = std::min(least, point_to_polytope(corner(i, lower, upper), polytope, edges));
  }
  for (const Edge& f : edges_of_box(lower, upper)) {
    for (const Edge& e : edges) least = std::min(least, edge_distance(e, f));
  }
  return least;
}

std::string sphere_faults(const Polytope& polytope, const BitGrid& raw,
                          const GridGeometry& geometry, double radius_m) {
  const std::vector<Vec3> vertices = vertices_of(polytope);
  if (vertices.size() < 4) return "the polytope is not bounded, or empty; ";
  Vec3 lower = vertices[0], upper = vertices[0];
  for (const Vec3& v : vertices) {
    lower = lower.cwiseMin(v);
    upper = upper.cwiseMax(v);
  }
  const Vec3 from = geometry.to_grid(lower.array() - radius_m).array().floor();
  const Vec3 to = geometry.to_grid(upper.array() + radius_m).array().floor();
  for (int z = int(from.z()); z <= int(to.z()); ++z) {
    for (int y = int(from.y()); y <= int(to.y()); ++y) {
      for (int x = int(from.x()); x <= int(to.x()); ++x) {
        if (!raw.contains({x, y, z}) || !raw.get({x, y, z})) continue;
        const Vec3 lo = geometry.lower_corner({x, y, z});
        const Vec3 hi = geometry.lower_corner({x + 1, y + 1, z + 1});
        bool far = false;  // a face is the plane between them
        for (int k = 0; k < polytope.faces() && !far; ++k) {
          double nearest = std::numeric_limits<double>::infinity();
          for (unsigned i = 0; i < 8; ++i) {
            nearest = std::min(nearest, polytope.A().row(k).dot(corner(i, lo, hi)));
          }
          far = nearest - polytope.b()[k] >= radius_m;
        }
        if (far || distance_to_box(polytope, lo, hi) > radius_m - 1e-9) continue;
        return "voxel " + to_text(Index3{x, y, z}) + " is nearer than the radius; ";
      }
    }
  }
  return "";
}

}  // namespace goshawk::corridor_builder::test_support
