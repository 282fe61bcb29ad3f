#pragma once

#include <cstdint>
#include <span>

#include "goshawk/core/result.hpp"
#include "goshawk/core/words.hpp"
#include "goshawk/map_server/voxel_map.hpp"

namespace goshawk::map_server {

/// Which map counts for a voxel that several of them know.
enum class MergeRule {
  occupied,  // an obstacle in any of them is an obstacle
  later,     // the last one that knows the voxel: what has left is gone
};

constexpr auto words_of(MergeRule) {
  using enum MergeRule;
  return std::to_array<Named<MergeRule>>({{occupied, "occupied"}, {later, "later"}});
}

/// One map of several, on the smallest raster that covers all; what none of them knows is unknown.
/// @return invalid_input for no map, or maps whose voxels differ in size; map_too_large
Result<RawVoxels> merge(std::span<const RawVoxels> maps, MergeRule rule, std::int64_t max_voxels);

/// The box around what is known. @return map_empty if nothing is
Result<RawVoxels> trimmed(const RawVoxels& map);

/// Voxels by what changed from one map to another.
struct MapDifference {
  std::int64_t same = 0;       // known in both, and alike
  std::int64_t appeared = 0;   // was free, is occupied
  std::int64_t vanished = 0;   // was occupied, is free
  std::int64_t learnt = 0;     // was unknown
  std::int64_t forgotten = 0;  // is unknown

  bool any() const { return appeared + vanished + learnt + forgotten > 0; }
};

/// @return as merge()
Result<MapDifference> difference(const RawVoxels& before, const RawVoxels& after,
                                 std::int64_t max_voxels);

}  // namespace goshawk::map_server
