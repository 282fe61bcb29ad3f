#include "grazing.hpp"

#include <algorithm>
#include <cmath>

namespace goshawk::map_server {
namespace {

constexpr int kMostHeld = 64;  // voxels of a surface that a ray grazes

}  // namespace

// Backwards from the end while the ray grazes. Masks in place of branches: which face comes next
// cannot be foretold.
Index3 Grazing::first_held(const Ray& ray) const {
  Index3 voxel = ray.last();
  std::int64_t x = ray.x.last_time(), y = ray.y.last_time(), z = ray.z.last_time();
  const int most = std::min(kMostHeld, ray.x.count + ray.y.count + ray.z.count - 1);
  std::optional<Layers> layers;  // most rays meet no obstacle before their end
  for (int k = 0; k < most; ++k) {
    const bool by_x = (x >= y) & (x >= z), by_y = !by_x & (y >= z), by_z = !by_x & !by_y;
    const Index3 previous{voxel.x - (ray.x.step & -int(by_x)), voxel.y - (ray.y.step & -int(by_y)),
                          voxel.z - (ray.z.step & -int(by_z))};
    x -= ray.x.every & -std::int64_t(by_x);
    y -= ray.y.every & -std::int64_t(by_y);
    z -= ray.z.every & -std::int64_t(by_z);
    if (!raw(previous)) break;
    if (!layers) layers = layers_of(ray);
    if (!grazed(*layers, previous)) break;
    voxel = previous;
  }
  return voxel;
}

// Across axes along which the ray moves at most half as fast as along its main one.
Grazing::Layers Grazing::layers_of(const Ray& ray) {
  struct Axis {
    int Index3::*axis;
    double way;
    const Crossings& crossings;
  };
  const std::array<Axis, 3> axes{Axis{&Index3::x, std::abs(ray.way.x()), ray.x},
                                 Axis{&Index3::y, std::abs(ray.way.y()), ray.y},
                                 Axis{&Index3::z, std::abs(ray.way.z()), ray.z}};
  const auto main = std::size_t(std::ranges::max_element(axes, {}, &Axis::way) - axes.begin());
  Layers layers;
  for (std::size_t a = 0; a < 3; ++a) {
    if (a == main || axes[a].way > 0.5 * axes[main].way) continue;
    Layer& layer = layers.all[std::size_t(layers.count++)];
    layer = {axes[a].axis, axes[a].crossings.last, {}, {}};
    layer.towards.*axes[a].axis = axes[a].crossings.step;
    layer.beside.*axes[3 - a - main].axis = 1;
  }
  return layers;
}

bool Grazing::grazed(const Layers& layers, Index3 voxel) const {
  for (int k = 0; k < layers.count; ++k) {
    const Layer& layer = layers.all[std::size_t(k)];
    if (voxel.*layer.axis != layer.last || raw(voxel - layer.towards)) continue;
    const bool backed = raw(voxel + layer.towards) || !known(voxel + layer.towards);
    if (backed && (raw(voxel + layer.beside) || raw(voxel - layer.beside))) return true;
  }
  return false;
}

}  // namespace goshawk::map_server
