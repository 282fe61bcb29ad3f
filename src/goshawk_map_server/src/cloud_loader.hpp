#pragma once

#include "goshawk/map_server/map_file.hpp"
#include "readers.hpp"

namespace goshawk::map_server {

/// Turns what a cloud file holds into voxels, or into a tree if it is a scan: pose, scale and origin
/// applied, cut to the box. Fills everything of `source` but its format.
Status load_cloud(Cloud cloud, const LoadOptions& options, MapSource& source);

}  // namespace goshawk::map_server
