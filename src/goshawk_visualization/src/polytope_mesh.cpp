#include "goshawk/visualization/polytope_mesh.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace goshawk::visualization {

namespace {

/// A square on the plane n p = offset, counter-clockwise seen from where n points.
Polygon large_square(const Vec3& n, double offset_m, double extent_m) {
  const Vec3 helper = std::abs(n.x()) < 0.6 ? Vec3::UnitX() : Vec3::UnitY();
  const Vec3 u = extent_m * n.cross(helper).normalized();
  const Vec3 v = n.cross(u);
  const Vec3 foot = offset_m * n;
  return {foot - u - v, foot + u - v, foot + u + v, foot - u + v};
}

/// Sutherland and Hodgman, 1974: the part of the polygon where n p <= offset.
Polygon clip(const Polygon& polygon, const Vec3& n, double offset_m) {
  Polygon kept;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec3& a = polygon[i];
    const Vec3& b = polygon[(i + 1) % polygon.size()];
    const double da = n.dot(a) - offset_m;
    const double db = n.dot(b) - offset_m;
    if (da <= 0.0) kept.push_back(a);
    if ((da < 0.0 && db > 0.0) || (da > 0.0 && db < 0.0))
      kept.push_back(a + da / (da - db) * (b - a));
  }
  return kept;
}

Polygon without_repeats(const Polygon& polygon) {
  constexpr double kSame_m = 1e-9;
  Polygon kept;
  for (const Vec3& p : polygon) {
    if (kept.empty() || (p - kept.back()).norm() > kSame_m) kept.push_back(p);
  }
  while (kept.size() > 1 && (kept.front() - kept.back()).norm() <= kSame_m) kept.pop_back();
  return kept;
}

/// Of planes that coincide only the first bounds the polytope.
bool repeats_earlier(const Polytope& polytope, int face) {
  for (int j = 0; j < face; ++j) {
    if ((polytope.A().row(j) - polytope.A().row(face)).norm() < 1e-12 &&
        std::abs(polytope.b()[j] - polytope.b()[face]) < 1e-12) {
      return true;
    }
  }
  return false;
}

double turn(const Eigen::Vector2d& o, const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return (a - o).x() * (b - o).y() - (a - o).y() * (b - o).x();
}

}  // namespace

std::vector<Polygon> face_polygons(const Polytope& polytope, double extent_m) {
  std::vector<Polygon> faces;
  for (int i = 0; i < polytope.faces(); ++i) {
    if (repeats_earlier(polytope, i)) continue;
    Polygon face = large_square(polytope.A().row(i), polytope.b()[i], extent_m);
    for (int j = 0; j < polytope.faces() && !face.empty(); ++j) {
      if (j != i) face = clip(face, polytope.A().row(j), polytope.b()[j]);
    }
    face = without_repeats(face);
    if (face.size() >= 3) faces.push_back(std::move(face));
  }
  return faces;
}

Mesh closed_mesh(const Polytope& polytope) {
  constexpr double kSame_m = 1e-6;
  Mesh mesh;
  const auto index_of = [&](const Vec3& p) {
    const auto same = [&](const Vec3& corner) { return (corner - p).norm() <= kSame_m; };
    const auto found = std::ranges::find_if(mesh.corners, same);
    const auto index = std::size_t(found - mesh.corners.begin());
    if (found == mesh.corners.end()) mesh.corners.push_back(p);
    return index;
  };
  for (const Polygon& polygon : face_polygons(polytope)) {
    std::vector<std::size_t> face;
    for (const Vec3& p : polygon) {
      const std::size_t corner = index_of(p);
      if (face.empty() || face.back() != corner) face.push_back(corner);
    }
    while (face.size() > 1 && face.front() == face.back()) face.pop_back();
    if (face.size() >= 3) mesh.faces.push_back(std::move(face));
  }
  return mesh;
}

std::vector<std::pair<std::size_t, std::size_t>> edges(const Mesh& mesh) {
  std::vector<std::pair<std::size_t, std::size_t>> result;
  for (const auto& face : mesh.faces) {
    for (std::size_t i = 0; i < face.size(); ++i) {
      const std::size_t from = face[i], to = face[(i + 1) % face.size()];
      if (from < to) result.emplace_back(from, to);  // the neighbouring face passes it backwards
    }
  }
  return result;
}

std::vector<Eigen::Vector2d> convex_hull(std::vector<Eigen::Vector2d> points) {
  std::sort(points.begin(), points.end(), [](const auto& a, const auto& b) {
    return a.x() < b.x() || (a.x() == b.x() && a.y() < b.y());
  });
  points.erase(std::unique(points.begin(), points.end()), points.end());
  if (points.size() < 3) return points;
  std::vector<Eigen::Vector2d> hull;
  const auto half = [&](auto begin, auto end) {
    const std::size_t base = hull.size();
    for (auto p = begin; p != end; ++p) {
      while (hull.size() >= base + 2 && turn(hull[hull.size() - 2], hull.back(), *p) <= 0.0) {
        hull.pop_back();
      }
      hull.push_back(*p);
    }
    hull.pop_back();  // the other half begins with it
  };
  half(points.begin(), points.end());
  half(points.rbegin(), points.rend());
  return hull;
}

}  // namespace goshawk::visualization
