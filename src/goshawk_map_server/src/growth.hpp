#pragma once

#include "goshawk/map_server/voxel_map.hpp"

namespace goshawk::map_server {

/// Row by row: what grows under the policy. Padding bits of the result are undefined.
inline BitGrid::Word growing_word(BitGrid::Word occupied, BitGrid::Word known,
                                  UnknownPolicy policy) {
  return policy == UnknownPolicy::occupied ? occupied | ~known : occupied;
}

/// What is added after the growth. Padding bits of the result are undefined.
inline BitGrid::Word finished_word(BitGrid::Word grown, BitGrid::Word known, UnknownPolicy policy) {
  return policy == UnknownPolicy::blocked ? grown | ~known : grown;
}

/// make_voxel_grid without the demand that something stays free.
Result<VoxelGrid> grow(const RawVoxels& raw, const Growth& growth, std::uint64_t version);

/// That no voxel of a map is free.
Error nothing_free(const Growth& growth);

}  // namespace goshawk::map_server
