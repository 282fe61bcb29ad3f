#pragma once

#include <array>
#include <optional>

#include "goshawk/core/brick_map.hpp"
#include "ray.hpp"

namespace goshawk::map_server {

/// Rays that graze a floor or a wall just before they end in the same surface: what they pass of
/// it is not seen to be free.
class Grazing {
 public:
  /// @param corner of the map's raster from where the rays count their voxels
  /// @param exchanged whether rays have x and y exchanged
  Grazing(const BrickMap& map, Index3 corner, bool exchanged)
      : map_(map), corner_(corner), exchanged_(exchanged) {}

  /// @return the first voxel of the surface that the ray ends in: those before it are passed
  Index3 first_held(const Ray& ray) const;

 private:
  /// How a surface across one axis lies to a ray.
  struct Layer {
    int Index3::*axis;
    int last;        // where the ray ends along the axis
    Index3 towards;  // one voxel behind the surface
    Index3 beside;   // one voxel along it, across the ray
  };
  struct Layers {
    std::array<Layer, 2> all;
    int count = 0;
  };
  static Layers layers_of(const Ray& ray);

  /// Is an obstacle part of such a surface: in the layer where the ray ends, with its free side
  /// towards the ray, more of it beside the ray, and no free space behind?
  bool grazed(const Layers& layers, Index3 voxel) const;
  Index3 in_map(Index3 voxel) const {
    return corner_ + (exchanged_ ? Index3{voxel.y, voxel.x, voxel.z} : voxel);
  }
  bool raw(Index3 voxel) const { return map_.is_raw(in_map(voxel)); }
  bool known(Index3 voxel) const { return map_.is_known(in_map(voxel)); }

  const BrickMap& map_;
  Index3 corner_;
  bool exchanged_;
};

}  // namespace goshawk::map_server
