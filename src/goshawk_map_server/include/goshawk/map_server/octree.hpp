#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

#include "goshawk/core/grid_geometry.hpp"
#include "goshawk/core/result.hpp"

namespace octomap {
class OcTree;
}

namespace goshawk::map_server {

/// OctoMap's tree is the store. Its heavy headers stay out of this interface: include
/// <octomap/OcTree.h> where the tree itself is used.
using OcTreePtr = std::shared_ptr<octomap::OcTree>;

/// An axis-aligned box, frame map [m].
struct Box {
  Vec3 lower_map = Vec3::Zero();
  Vec3 upper_map = Vec3::Zero();

  /// Lower faces included, upper ones not.
  bool holds(const Vec3& p_map) const {
    return (p_map.array() >= lower_map.array()).all() && (p_map.array() < upper_map.array()).all();
  }
};

/// The smallest grid on the tree's raster (voxel faces at multiples of the resolution) that
/// holds the box. @return invalid_parameter for a box that is empty or not finite, map_too_large
/// beyond OctoMap's 65536 voxels a side or max_voxels
Result<GridGeometry> raster_of(const Box& box, double resolution_m, std::int64_t max_voxels);

/// Builds the tree whose leaves say exactly what the bits say; uniform regions become one leaf.
/// @param occupied, known of geometry.size; where known is not set, occupied is ignored; an
/// empty `known` means that all voxels are known
/// @return invalid_parameter if the origin is not a multiple of the resolution, map_empty if
/// nothing is known, map_too_large outside OctoMap's reach
Result<OcTreePtr> make_octree(const GridGeometry& geometry, const BitGrid& occupied,
                              const BitGrid& known);

/// Writes .bt (occupancy only) or .ot (log-odds as well), by the ending; a file that was there
/// before is replaced only when all went well. @return io_failed, or map_unreadable for another
/// ending
Status save_octree(const octomap::OcTree& tree, const std::string& path);

/// make_octree and save_octree in one: for worlds.
Status save_voxels(const GridGeometry& geometry, const BitGrid& occupied, const BitGrid& known,
                   const std::string& path);

/// @return the tree's occupancy without a header, as octomap_msgs/Octomap carries it (binary)
std::string binary_payload(const octomap::OcTree& tree);
/// The same of bits, without a tree; empty if nothing is known. @return as make_octree()
Result<std::string> binary_payload(const GridGeometry& geometry, const BitGrid& occupied,
                                   const BitGrid& known);

/// The tree of such a payload. @param resolution_m [m] from 1e-6 to 1e3
/// @return map_malformed if it is not one whole tree, map_empty if it holds no node
Result<OcTreePtr> read_binary_payload(std::string_view payload, double resolution_m);

}  // namespace goshawk::map_server
