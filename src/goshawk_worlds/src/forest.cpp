#include <algorithm>
#include <cmath>

#include "builder.hpp"

namespace goshawk::worlds {
namespace {

struct Tree {
  double x, y;          // [voxels] the trunk's axis
  double trunk_radius;  // [voxels]
  double height;        // [voxels]
  double crown_radius;  // [voxels] 0: no crown
  double crown_center;  // [voxels] height of the crown's middle
};

// Distance from a point to the interval [i, i + 1] on one axis: what a whole cube needs.
double gap(double point, int i) {
  return std::max({0.0, double(i) - point, point - (i + 1.0)});
}

// A voxel belongs to the tree when its cube comes nearer to the axis than the trunk's radius, or
// nearer to the crown's middle than the crown's radius. Squares are compared: no root, no rounding
// that differs from machine to machine.
Shape rasterize(const Tree& tree) {
  const double reach = std::max(tree.trunk_radius, tree.crown_radius);
  const int x0 = int(std::floor(tree.x - reach));
  const int y0 = int(std::floor(tree.y - reach));
  const int top =
      std::max(1, int(std::ceil(std::max(tree.height, tree.crown_center + tree.crown_radius))));
  const int width = int(std::ceil(2.0 * reach)) + 2;
  Shape shape{{x0, y0, 0}, BitGrid({width, width, top}, false)};
  for (int z = 0; z < top; ++z) {
    for (int y = 0; y < width; ++y) {
      for (int x = 0; x < width; ++x) {
        const double dx = gap(tree.x, x + x0);
        const double dy = gap(tree.y, y + y0);
        const double dz = gap(tree.crown_center, z);
        const double across = dx * dx + dy * dy;
        const bool trunk = z < tree.height && across < tree.trunk_radius * tree.trunk_radius;
        const bool crown = across + dz * dz < tree.crown_radius * tree.crown_radius;
        if (trunk || crown) shape.voxels.set({x, y, z}, true);
      }
    }
  }
  return shape;
}

}  // namespace

Result<World> make_forest(const WorldSpec& spec, const GridGeometry& geometry) {
  Builder builder(spec, geometry);
  Random random(spec.seed);
  const Index3 world = geometry.size;
  const double res = spec.resolution_m;

  const auto draw = [&](double scale) {
    Tree tree{};
    tree.x = random.uniform(0.0, world.x);
    tree.y = random.uniform(0.0, world.y);
    tree.trunk_radius = scale * random.uniform(0.2, 0.4) / res;
    tree.height = scale * random.uniform(0.6, 1.2) * world.z;
    tree.crown_center = tree.height;
    // Shrunk trees are there to meet the density exactly: stumps, without a crown.
    if (random.chance(0.4) && scale == 1.0) tree.crown_radius = random.uniform(0.5, 1.0) / res;
    return rasterize(tree);
  };

  builder.refresh();
  if (auto filled = fill_to_density(builder, spec.density, draw); !filled) return filled.error();
  return World{geometry, builder.take_occupied()};
}

}  // namespace goshawk::worlds
