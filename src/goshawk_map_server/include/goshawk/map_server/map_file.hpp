#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "goshawk/core/result.hpp"
#include "goshawk/core/vector.hpp"
#include "goshawk/core/words.hpp"
#include "goshawk/map_server/octree.hpp"

namespace goshawk::map_server {

/// What the points of a cloud file say about the space between them.
enum class CloudMeaning {
  map,     // a finished map: points are occupied, the rest of the box is free
  points,  // points are occupied, nothing is known of the rest
  scan,    // one scan: the rays from the sensor to the points are free, the rest unknown; points
           // at the sensor itself are missing returns
};

constexpr auto words_of(CloudMeaning) {
  using enum CloudMeaning;
  return std::to_array<Named<CloudMeaning>>({{map, "map"}, {points, "points"}, {scan, "scan"}});
}

/// How to read files that do not say it themselves. OctoMap files bring their resolution and their
/// knowledge of free space along and use only max_voxels.
struct LoadOptions {
  double resolution_m = 0.2;  // voxel edge of clouds and .3dmap files
  CloudMeaning cloud = CloudMeaning::map;
  Vec3 sensor_origin_map = Vec3::Zero();  // [m] for CloudMeaning::scan
  double max_range_m = 30.0;              // [m] for CloudMeaning::scan
  std::optional<Box> box;                 // clouds: points outside are skipped
  std::int64_t max_voxels = 1'000'000'000;
};

/// A map as it was read: the tree, and what the reading left out.
struct MapSource {
  OcTreePtr tree;                      // never null in a success
  std::string format;                  // "bt", "ot", "pcd", "ply" or "3dmap"
  std::int64_t points_read = 0;        // clouds and .3dmap: entries in the file
  std::int64_t points_not_finite = 0;  // skipped
  std::int64_t points_outside = 0;     // skipped: outside LoadOptions::box
};

/// Reads a map by the ending of its name:
///   .bt, .ot   OctoMap, of OcTree (.ot: also ColorOcTree, colours dropped)
///   .pcd       ascii, binary, binary_compressed; float fields x, y, z among any others
///   .ply       ascii, binary little and big endian; float x, y, z of the element vertex
///   .3dmap     Warframe voxel maps: "voxel X Y Z", then one occupied voxel a line; voxel
///              (0, 0, 0) has its lower corner at the origin, what is not listed is free
///
/// @return map_unreadable (missing, not a file, unknown ending), map_malformed (truncated or not
/// what its ending says), map_empty (no usable voxel), map_too_large, invalid_parameter (options)
Result<MapSource> load_map(const std::string& path, const LoadOptions& options = {});

/// The same for bytes that are in memory already.
/// @param name stands in sentences; its ending says what the bytes are
Result<MapSource> load_map_bytes(std::string_view bytes, const std::string& name,
                                 const LoadOptions& options = {});

}  // namespace goshawk::map_server
