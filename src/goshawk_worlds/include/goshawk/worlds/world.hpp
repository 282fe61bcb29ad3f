#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "goshawk/core/grid_geometry.hpp"
#include "goshawk/core/result.hpp"

namespace goshawk::worlds {

/// A made-up world, told by a few numbers. The same spec gives the same bytes on every machine.
///
/// What `density` means depends on the kind (docs/method.md):
///   noise   every voxel is occupied with this probability, independently of all others
///   boxes   boxes and floor-to-ceiling pillars are added until this share of the grown map is
///           blocked, within kDensityTolerance
///   forest  the same with round trunks, some with a crown
///   office  rooms on both sides of a corridor, walls with doors, then furniture until this share
///           of the grown map is blocked; if the walls alone block more, no furniture
struct WorldSpec {
  std::string kind = "boxes";  // one of world_kinds()
  Vec3 size_m = Vec3(6.0, 8.0, 4.0);
  Vec3 origin_m = Vec3::Zero();  // [m] lower corner, frame map
  double resolution_m = 0.2;     // [m] edge of a voxel
  double density = 0.4;          // [0, 0.95]
  std::uint64_t seed = 1;
  double inflation_m = 0.2;  // [m] the growth that density and keep_free refer to
  /// [m, frame map] These points lie in free voxels after the growth (every voxel whose closed
  /// cube holds the point is free). That a way joins them is likely, not promised.
  std::vector<Vec3> keep_free;
};

/// Obstacles as they are, not grown; every voxel is known.
struct World {
  GridGeometry geometry;
  BitGrid occupied;
};

/// How far the blocked share of the grown map may be from WorldSpec::density.
inline constexpr double kDensityTolerance = 0.005;

/// "boxes", "forest", "noise", "office"
const std::vector<std::string>& world_kinds();

/// The world of the thesis' trajectory tables: 6 x 8 x 4 m of boxes and pillars at 0.2 m, 0.4 of
/// the grown map blocked, (3, 0, 1) and (3, 8, 2) free. Both points lie on a face of that box, so
/// it is padded by two voxels in y on both sides (docs/method.md).
WorldSpec default_world();

/// @return invalid_parameter for a spec that says nothing sensible, or a density that this kind
/// cannot reach in this size; invalid_input for a keep_free point outside; map_too_large
Result<World> make_world(const WorldSpec& spec);

}  // namespace goshawk::worlds
