#pragma once

#include <cstdint>
#include <optional>

#include "goshawk/core/grid_geometry.hpp"
#include "goshawk/core/result.hpp"
#include "goshawk/core/words.hpp"
#include "goshawk/map_server/octree.hpp"

namespace goshawk::map_server {

/// What the tree says, as bits: nothing grown, no policy applied.
struct RawVoxels {
  GridGeometry geometry;  // on the tree's raster
  BitGrid occupied;       // outside is occupied; only known voxels are set
  BitGrid known;          // outside is unknown
};

struct VoxelizeOptions {
  std::optional<Box> box;  // [m]; without: the box around all that is known
  std::int64_t max_voxels = 1'000'000'000;
};

/// Writes the tree's leaves as runs of bits: the cost goes with leaves and rows, not with voxels.
/// @return map_empty for a tree that knows nothing, map_too_large, invalid_parameter (box)
Result<RawVoxels> voxelize(const octomap::OcTree& tree, const VoxelizeOptions& options = {});

/// What counts as an obstacle where nothing was measured.
enum class UnknownPolicy {
  occupied,  // unknown voxels are obstacles and grow like them: nothing unseen comes near
  blocked,   // unknown voxels are obstacles but do not grow: the body may reach into them
  free,      // unknown voxels are free
};

constexpr auto words_of(UnknownPolicy) {
  using enum UnknownPolicy;
  return std::to_array<Named<UnknownPolicy>>(
      {{occupied, "occupied"}, {blocked, "blocked"}, {free, "free"}});
}

/// How raw voxels become what the planning stages see.
struct Growth {
  UnknownPolicy unknown = UnknownPolicy::occupied;
  double inflation_m = 0.2;  // [m] the vehicle's radius plus its margin
  double reserve_m = 0.0;    // [m] that plans keep beyond it
};

/// Applies the policy and inflates the obstacles (goshawk::inflate), by the inflation and the
/// reserve. The grid's inflation_m is without the reserve: what is flown keeps to that.
/// @return with raw voxels; invalid_input for a bad inflation, map_empty if no voxel stays free
Result<VoxelGrid> make_voxel_grid(const RawVoxels& raw, const Growth& growth,
                                  std::uint64_t version);

}  // namespace goshawk::map_server
