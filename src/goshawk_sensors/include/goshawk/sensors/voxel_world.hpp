#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "goshawk/core/grid_geometry.hpp"
#include "goshawk/core/words.hpp"
#include "goshawk/sensors/world.hpp"

namespace goshawk::sensors {

/// What rays meet that leave the grid.
enum class Boundary {
  open,   // nothing
  floor,  // a floor without end at the height of the grid's lower face
  box,    // the faces of the grid's box: floor, walls and ceiling
};

constexpr auto words_of(Boundary) {
  using enum Boundary;
  return std::to_array<Named<Boundary>>({{open, "open"}, {floor, "floor"}, {box, "box"}});
}

/// Occupied voxels as solid cubes. Rays step from voxel to voxel (Amanatides and Woo 1987) where
/// something is near, and over whole cubes of empty blocks where nothing is: each block of 4 x 4 x
/// 4 voxels knows the Chebyshev distance to the nearest block that is not empty. Plane by plane the
/// crossings are computed anew from the ray's origin, so no error adds up along a ray.
///
/// Memory: 9 bytes for each block of 64 voxels.
class VoxelWorld : public World {
 public:
  /// @pre geometry.check() is ok and the sizes agree (throws std::invalid_argument else)
  VoxelWorld(const GridGeometry& geometry, const BitGrid& occupied, Boundary boundary);

  void cast(std::span<const Ray> rays, std::span<Hit> hits) const override;
  bool contains(const Vec3& point) const override;

  const GridGeometry& geometry() const { return geometry_; }

 private:
  struct Walk;

  void fill_masks(const BitGrid& occupied);
  void fill_distances();
  void spread(bool forward);
  Hit cast_one(const Ray& ray) const;
  Hit boundary_hit(const Ray& ray) const;
  bool occupied(const Walk& walk) const;
  std::size_t block_at(int bx, int by, int bz) const {
    return (std::size_t(bz) * blocks_[1] + std::size_t(by)) * blocks_[0] + std::size_t(bx);
  }

  GridGeometry geometry_;
  Boundary boundary_;
  double voxels_per_m_;
  std::array<int, 3> size_{};            // voxels
  std::array<std::size_t, 3> blocks_{};  // blocks of 4 x 4 x 4 voxels
  std::vector<std::uint64_t> masks_;     // bit 16 z + 4 y + x of a block: occupied
  std::vector<std::uint8_t> distances_;  // [blocks] to the nearest that is not empty; at most 255
};

}  // namespace goshawk::sensors
