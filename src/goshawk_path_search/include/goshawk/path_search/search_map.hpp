#pragma once

#include <memory>
#include <optional>

#include "goshawk/core/grid_geometry.hpp"
#include "goshawk/path_search/config.hpp"

namespace goshawk::path_search {

/// A box in frame map, corners included.
struct SearchBox {
  Vec3 lower_map;  // [m]
  Vec3 upper_map;  // [m]
};

/// @param text six numbers between commas: x0,y0,z0,x1,y1,z1 [m]; empty for no box
/// @return invalid_parameter where it is neither, or the box is empty or not finite
Result<std::optional<SearchBox>> parse_search_box(const std::string& text);

/// The map as a search with this configuration sees it: cut to the voxels whose centres lie in the
/// box, unknown space blocked where `unknown` says so. Where nothing changes it is `map` itself.
/// @return map_empty where the box holds no voxel; invalid_parameter where `unknown` is free or
/// costly, but the map counts unknown space as occupied
Result<std::shared_ptr<const VoxelGrid>> make_search_map(std::shared_ptr<const VoxelGrid> map,
                                                         const Config& config,
                                                         const std::optional<SearchBox>& box);

/// The voxels never measured. Nothing where all are known.
std::optional<BitGrid> unknown_voxels(const VoxelGrid& map);

}  // namespace goshawk::path_search
