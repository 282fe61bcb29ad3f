#pragma once

#include "goshawk/map_server/voxel_map.hpp"

namespace goshawk::map_server {

/// That no voxel of a map is free.
Error nothing_free(const Growth& growth);

}  // namespace goshawk::map_server
