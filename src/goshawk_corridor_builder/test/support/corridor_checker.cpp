#include "corridor_checker.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <vector>

namespace goshawk::corridor_builder::test_support {
namespace {

constexpr double kRounding_m = 1e-9;

bool inside(const Polytope& polytope, const Vec3& p, double tolerance) {
  for (int i = 0; i < polytope.faces(); ++i) {
    if (polytope.A().row(i).dot(p) > polytope.b()[i] + tolerance) return false;
  }
  return true;
}

bool separates(const Vec3& n, double b, const Vec3& lower, const Vec3& upper) {
  for (unsigned corner = 0; corner < 8; ++corner) {
    const Vec3 p((corner & 1U) ? upper.x() : lower.x(), (corner & 2U) ? upper.y() : lower.y(),
                 (corner & 4U) ? upper.z() : lower.z());
    if (n.dot(p) < b - 1e-12) return false;
  }
  return true;
}

Polytope with_box(const Polytope& polytope, const Vec3& lower, const Vec3& upper) {
  Polytope both = polytope;
  for (int axis = 0; axis < 3; ++axis) {
    both.add(Vec3::Unit(axis), upper[axis]);
    both.add(-Vec3::Unit(axis), -lower[axis]);
  }
  return both;
}

// Is the whole path, from start to goal, inside the union of the polytopes?
bool path_connects(const Corridor& corridor) {
  for (std::size_t k = 0; k < corridor.polytopes.size(); ++k) {
    for (const std::size_t end : {k, k + 1}) {
      if (!inside(corridor.polytopes[k], corridor.waypoints_map[end], kRounding_m)) return false;
    }
  }
  return true;
}

std::string cube_faults(const Polytope& polytope, const VoxelGrid& grid, std::size_t k) {
  const std::vector<Vec3> vertices = vertices_of(polytope);
  if (vertices.size() < 4) return "polytope " + std::to_string(k) + " is not bounded, or empty; ";
  Vec3 lower = vertices[0], upper = vertices[0];
  for (const Vec3& v : vertices) {
    lower = lower.cwiseMin(v);
    upper = upper.cwiseMax(v);
  }
  const Vec3 from = grid.geometry.to_grid(lower), to = grid.geometry.to_grid(upper);
  if (!(to - from).allFinite() || (to - from).maxCoeff() > 1e4) {
    return "polytope " + std::to_string(k) + " is not bounded; ";
  }
  for (int z = int(std::floor(from.z())); z <= int(std::floor(to.z())); ++z) {
    for (int y = int(std::floor(from.y())); y <= int(std::floor(to.y())); ++y) {
      for (int x = int(std::floor(from.x())); x <= int(std::floor(to.x())); ++x) {
        const Index3 i{x, y, z};
        if (!grid.grown.test(i)) continue;
        const Vec3 lo = grid.geometry.lower_corner(i);
        const Vec3 hi = grid.geometry.lower_corner({x + 1, y + 1, z + 1});
        if (interiors_meet(polytope, lo, hi)) {
          return "polytope " + std::to_string(k) + " cuts into voxel " + to_text(i) + "; ";
        }
      }
    }
  }
  return "";
}

}  // namespace

std::vector<Vec3> vertices_of(const Polytope& polytope) {
  std::vector<Vec3> vertices;
  const int m = polytope.faces();
  for (int i = 0; i < m; ++i) {
    for (int j = i + 1; j < m; ++j) {
      const Vec3 ni = polytope.A().row(i), nj = polytope.A().row(j);
      const Vec3 line = ni.cross(nj);
      if (line.norm() < 1e-9) continue;
      for (int k = j + 1; k < m; ++k) {
        const Vec3 nk = polytope.A().row(k);
        const double det = line.dot(nk);
        if (std::abs(det) < 1e-9) continue;
        const Vec3 p = (polytope.b()[i] * nj.cross(nk) + polytope.b()[j] * nk.cross(ni) +
                        polytope.b()[k] * line) /
                       det;
        if (inside(polytope, p, kRounding_m)) vertices.push_back(p);
      }
    }
  }
  return vertices;
}

bool interiors_meet(const Polytope& polytope, const Vec3& lower, const Vec3& upper) {
  for (int i = 0; i < polytope.faces(); ++i) {
    if (separates(polytope.A().row(i), polytope.b()[i], lower, upper)) return false;
  }
  const Polytope both = with_box(polytope, lower, upper);
  const std::vector<Vec3> vertices = vertices_of(both);
  if (vertices.size() < 4) return false;
  Vec3 mean = Vec3::Zero();
  for (const Vec3& v : vertices) mean += v / double(vertices.size());
  return both.violation(mean) < -2.0 * kRounding_m;
}

double volume_of(const Polytope& polytope) {
  const std::vector<Vec3> vertices = vertices_of(polytope);
  if (vertices.size() < 4) return 0.0;
  Vec3 lower = vertices[0], upper = vertices[0];
  for (const Vec3& v : vertices) {
    lower = lower.cwiseMin(v);
    upper = upper.cwiseMax(v);
  }
  constexpr int kLines = 60;
  const double dy = (upper.y() - lower.y()) / kLines, dz = (upper.z() - lower.z()) / kLines;
  double volume = 0.0;
  for (int j = 0; j < kLines; ++j) {
    for (int k = 0; k < kLines; ++k) {
      const Vec3 p(0.0, lower.y() + (j + 0.5) * dy, lower.z() + (k + 0.5) * dz);
      double from = lower.x(), to = upper.x();
      for (int i = 0; i < polytope.faces(); ++i) {
        const double n = polytope.A()(i, 0);
        const double rest = polytope.b()[i] - polytope.A().row(i).dot(p);
        if (n > 1e-12) to = std::min(to, rest / n);
        if (n < -1e-12) from = std::max(from, rest / n);
        if (std::abs(n) <= 1e-12 && rest < 0.0) to = from;
      }
      volume += std::max(0.0, to - from) * dy * dz;
    }
  }
  return volume;
}

bool cuts_into_a_voxel(const Polytope& polytope, const VoxelGrid& grid) {
  return !cube_faults(polytope, grid, 0).empty();
}

std::string faults_of(const Corridor& corridor, const VoxelGrid& grid,
                      std::span<const Vec3> path_map) {
  std::string faults;
  if (auto status = corridor.check(); !status) faults += status.error().message + "; ";
  if (corridor.waypoints_map.front() != path_map.front()) faults += "start moved; ";
  if (corridor.waypoints_map.back() != path_map.back()) faults += "goal moved; ";
  if (!path_connects(corridor)) faults += "a waypoint is outside its polytopes; ";
  for (std::size_t k = 0; k < corridor.overlaps.size(); ++k) {
    const Ball& ball = corridor.overlaps[k];
    if (!(ball.radius_m > 1e-6)) faults += "an overlap has no radius; ";
    for (const std::size_t side : {k, k + 1}) {
      const Polytope& polytope = corridor.polytopes[side];
      if (polytope.violation(ball.center_map) > -ball.radius_m + 1e-9) {
        faults += "overlap " + std::to_string(k) + " is not inside polytope; ";
      }
    }
  }
  for (std::size_t k = 0; k < corridor.polytopes.size(); ++k) {
    faults += cube_faults(corridor.polytopes[k], grid, k);
  }
  return faults;
}

}  // namespace goshawk::corridor_builder::test_support
