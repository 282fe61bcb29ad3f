#include "corridor/quality.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "support/corridor_checker.hpp"

namespace goshawk::bench {
namespace {

using corridor_builder::test_support::vertices_of;

constexpr int kLinesAVoxel = 3;

// How much of [from, to] along a row of voxels is occupied, in voxel edges.
double occupied_between(const BitGrid& occupied, double from, double to, int y, int z) {
  double sum = 0.0;
  for (int x = int(std::floor(from)); x < to; ++x) {
    if (!occupied.test({x, y, z})) continue;
    sum += std::min(to, x + 1.0) - std::max(from, double(x));
  }
  return sum;
}

}  // namespace

Volume volume_of(const Polytope& polytope, const VoxelGrid& grid) {
  const std::vector<Vec3> vertices = vertices_of(polytope);
  Volume volume;
  if (vertices.size() < 4) return volume;
  Vec3 lower = vertices[0], upper = vertices[0];
  for (const Vec3& v : vertices) {
    lower = lower.cwiseMin(v);
    upper = upper.cwiseMax(v);
  }
  const GridGeometry& g = grid.geometry;
  const Vec3 from = g.to_grid(lower), to = g.to_grid(upper);
  const double step = 1.0 / kLinesAVoxel;
  for (double z = (std::floor(from.z() / step) + 0.5) * step; z < to.z(); z += step) {
    for (double y = (std::floor(from.y() / step) + 0.5) * step; y < to.y(); y += step) {
      const Vec3 p = g.origin_map + g.resolution_m * Vec3(0.0, y, z);
      double first = from.x(), last = to.x();
      for (int i = 0; i < polytope.faces(); ++i) {
        const double n = polytope.A()(i, 0) * g.resolution_m;
        const double rest = polytope.b()[i] - polytope.A().row(i).dot(p);
        if (n > 1e-12) last = std::min(last, rest / n);
        if (n < -1e-12) first = std::max(first, rest / n);
        if (std::abs(n) <= 1e-12 && rest < 0.0) last = first;
      }
      if (!(last > first)) continue;
      volume.total_m3 += last - first;
      volume.stolen_m3 +=
          occupied_between(grid.grown, first, last, int(std::floor(y)), int(std::floor(z)));
    }
  }
  const double cell_m3 = std::pow(g.resolution_m, 3) * step * step;
  volume.total_m3 *= cell_m3;
  volume.stolen_m3 *= cell_m3;
  return volume;
}

int faces_of(const Polytope& polytope) {
  const std::vector<Vec3> vertices = vertices_of(polytope);
  int faces = 0;
  for (int i = 0; i < polytope.faces(); ++i) {
    const auto touching = std::count_if(vertices.begin(), vertices.end(), [&](const Vec3& v) {
      return std::abs(polytope.A().row(i).dot(v) - polytope.b()[i]) < 1e-8;
    });
    faces += touching >= 3;
  }
  return faces;
}

}  // namespace goshawk::bench
