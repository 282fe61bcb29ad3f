#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "goshawk/core/result.hpp"
#include "goshawk/core/vector.hpp"
#include "goshawk/core/words.hpp"
#include "goshawk/map_server/octree.hpp"
#include "goshawk/map_server/voxel_map.hpp"

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

/// What the points of a file with a viewpoint (PCD's VIEWPOINT: the sensor's pose) refer to.
enum class CloudFrame {
  automatic,  // a turned viewpoint: sensor; one that is only moved: map for a scan, else refused
  sensor,     // the sensor: the pose is applied to the points
  map,        // the map already: the viewpoint only says where the sensor was
};

constexpr auto words_of(CloudFrame) {
  using enum CloudFrame;
  return std::to_array<Named<CloudFrame>>(
      {{automatic, "automatic"}, {sensor, "sensor"}, {map, "map"}});
}

/// How to read files that do not say it themselves. OctoMap files bring their resolution and their
/// knowledge of free space along and use only max_voxels.
struct LoadOptions {
  double resolution_m = 0.2;  // voxel edge of clouds, meshes and .3dmap files
  CloudMeaning cloud = CloudMeaning::map;
  CloudFrame frame = CloudFrame::automatic;
  double scale = 1.0;  // [m] a unit of the file's coordinates
  /// [m] where the map frame's origin lies in the file's coordinates (scaled): subtracted
  Vec3 origin_file = Vec3::Zero();
  /// [rad] how the file's axes are turned into the map's, after that: about x, then y, then z of the
  /// map. A mesh whose y axis points up needs (pi / 2, 0, 0).
  Vec3 turn_rad = Vec3::Zero();
  /// Leaves out points far from all others, and occupied voxels that touch no other: noise of a
  /// scanner. Never of a mesh.
  bool drop_outliers = false;
  std::optional<Vec3> sensor_origin_map;  // [m] for a scan; else the file's viewpoint, or zero
  double max_range_m = 30.0;              // [m] for a scan
  std::optional<Box> box;                 // points outside are skipped, rays and faces cut
  std::int64_t max_voxels = 1'000'000'000;
};

/// A map as it was read: a tree or voxels, and what there is to say about it.
struct MapSource {
  OcTreePtr tree;                   // of OctoMap files and scans, else null
  std::optional<RawVoxels> voxels;  // of all others
  std::string format;               // the ending in lower case: "bt", "3dmap"
  std::int64_t points_read = 0;     // clouds and .3dmap: entries in the file
  std::int64_t triangles_read = 0;  // of a mesh
  std::int64_t points_not_finite = 0;  // skipped
  std::int64_t points_outside = 0;     // skipped: outside LoadOptions::box
  std::int64_t outliers = 0;           // points and voxels that LoadOptions::drop_outliers left out
  std::vector<std::string> notes;      // what was assumed, or looks wrong; sentences
};

/// The points of a .pcd or .ply file as they stand there, not finite ones included, without any
/// voxels. @return map_unreadable, map_malformed
Result<std::vector<Vec3>> load_points(const std::string& path);

/// The voxels of a map that was read, as voxelize() gives them for a tree.
Result<RawVoxels> voxelize(const MapSource& source, const VoxelizeOptions& options = {});

/// Reads a map by the ending of its name:
///   .bt, .ot   OctoMap, of OcTree (.ot: also ColorOcTree, colours dropped)
///   .pcd       ascii, binary, binary_compressed; fields x, y, z (float or integer) among any others
///   .ply       ascii, binary little and big endian; x, y, z of the element vertex; faces, strips and
///              edges set every voxel that they pass through
///   .stl       text and binary: the same for its triangles
///   .obj       the same for its faces and lines
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
