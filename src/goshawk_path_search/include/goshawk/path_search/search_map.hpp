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
/// @return invalid_parameter if it is neither, or the box is empty or not finite
Result<std::optional<SearchBox>> parse_search_box(const std::string& text);

/// The map as a search sees it: cut to the voxels whose centres lie in the box, unknown space
/// blocked if the rule says so. If neither changes anything it is the map itself.
class SearchMap {
 public:
  SearchMap() = default;
  SearchMap(UnknownRule unknown, const std::optional<SearchBox>& box)
      : unknown_(unknown), box_(box) {}

  /// Of a map with the same geometry as the one before, only chunks that differ are looked at.
  /// @return map_empty if the box holds no voxel; invalid_parameter if the rule is free or costly,
  /// but the map counts unknown space as occupied
  Result<std::shared_ptr<const VoxelGrid>> follow(std::shared_ptr<const VoxelGrid> map);

 private:
  Status place(const GridGeometry& geometry);
  Status begin(const VoxelGrid& map);
  void derive(const VoxelGrid& map);

  UnknownRule unknown_ = UnknownRule::as_mapped;
  std::optional<SearchBox> box_;
  std::shared_ptr<const VoxelGrid> source_;
  bool blocks_unknown_ = false;  // in derived_
  Index3 lower_;                 // of derived_ in source_ [voxels]
  VoxelGrid derived_;
};

}  // namespace goshawk::path_search
