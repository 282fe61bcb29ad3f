#pragma once

#include <optional>
#include <string>

#include "goshawk/core/bit_grid.hpp"
#include "goshawk/core/result.hpp"
#include "goshawk/core/vector.hpp"

namespace goshawk {

/// Where a grid lies: frame `map`, ENU, z up. Voxel (0, 0, 0) is the cube
/// [origin, origin + resolution]^3; indices grow along the axes.
struct GridGeometry {
  Vec3 origin_map = Vec3::Zero();  // [m] lower corner of voxel (0, 0, 0)
  double resolution_m = 0.2;       // [m] edge of a voxel
  Index3 size;                     // voxels along x, y, z

  /// Finite origin, resolution > 0, size that a BitGrid can hold.
  Status check() const;

  /// @param p_map [m] finite @return the voxel that contains it (a shared face belongs to the
  /// upper voxel), or nothing if p_map is outside or not finite
  std::optional<Index3> index_of(const Vec3& p_map) const;

  Vec3 lower_corner(Index3 i) const { return origin_map + resolution_m * Vec3(i.x, i.y, i.z); }
  Vec3 center(Index3 i) const {
    return origin_map + resolution_m * Vec3(i.x + 0.5, i.y + 0.5, i.z + 0.5);
  }
  Vec3 upper_corner_map() const { return lower_corner(size); }

  /// @param p_map [m] @return p_map in voxel units: voxel i is [i, i + 1]
  Vec3 to_grid(const Vec3& p_map) const { return (p_map - origin_map) / resolution_m; }

  friend bool operator==(const GridGeometry&, const GridGeometry&) = default;
};

/// What the planning stages see: obstacles inflated by the vehicle, the unknown policy applied.
/// Frame `map`. A copy shares the bits (BitGrid).
struct VoxelGrid {
  GridGeometry geometry;
  BitGrid grown;     // blocked for the vehicle's centre; outside is blocked
  BitGrid known;     // measured at all; outside is unknown; may be empty if all is known
  BitGrid raw = {};  // obstacles as measured, before inflation; outside is occupied; may be empty
  std::uint64_t version = 0;
  double inflation_m = 0.0;         // [m] by how much obstacles were inflated
  bool unknown_is_occupied = true;  // space that is not known is blocked in `grown`
  bool unknown_grows = false;       // it was inflated as well, like an obstacle

  /// The geometry and the bit grids agree in size.
  Status check() const;

  bool is_known(Index3 i) const { return known.empty() ? geometry_contains(i) : known.test(i); }

 private:
  bool geometry_contains(Index3 i) const { return grown.contains(i); }
};

/// Which end of a plan a point is, for error codes and sentences.
enum class Endpoint { start, goal };

/// @return the voxel of p_map, or why the vehicle cannot be there: not finite (invalid_input),
/// X_outside, X_unknown (unknown counts as occupied and this voxel is not known) or X_occupied
Result<Index3> locate(const VoxelGrid& grid, const Vec3& p_map, Endpoint endpoint);

}  // namespace goshawk
