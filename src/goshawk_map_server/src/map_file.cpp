#include "goshawk/map_server/map_file.hpp"

#include <octomap/OcTree.h>

#include <filesystem>
#include <fstream>
#include <new>

#include "cloud_loader.hpp"
#include "readers.hpp"
#include "text.hpp"

namespace goshawk::map_server {
namespace {

constexpr std::uintmax_t kMaxFileBytes = std::uintmax_t{4} << 30;

Result<std::string> read_bytes(const std::string& path) {
  namespace fs = std::filesystem;
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (!fs::exists(status)) {
    return fail(ErrorCode::map_unreadable, "there is no such file: check the path");
  }
  // A pipe or a device would block or never end.
  if (!fs::is_regular_file(status)) {
    return fail(ErrorCode::map_unreadable, "it is not a file: give the path of a map file");
  }
  const std::uintmax_t size = fs::file_size(path, error);
  if (error) return fail(ErrorCode::map_unreadable, "its size cannot be read: " + error.message());
  if (size > kMaxFileBytes) {
    return fail(ErrorCode::map_too_large, "it is larger than 4 GiB: cut it, or thin it out");
  }
  std::ifstream file(path, std::ios::binary);
  std::string bytes(std::size_t(size), '\0');
  if (!file || !file.read(bytes.data(), std::streamsize(size))) {
    return fail(ErrorCode::map_unreadable, "it cannot be read: check its permissions");
  }
  return bytes;
}

Status load_warframe(const WarframeMap& map, const LoadOptions& options, MapSource& source) {
  const double res = options.resolution_m;
  const auto geometry = raster_of({Vec3::Zero(), res * Vec3(map.size.x, map.size.y, map.size.z)},
                                  res, options.max_voxels);
  if (!geometry) return geometry.error();
  BitGrid occupied(map.size, true);
  for (const Index3 i : map.occupied) occupied.set(i, true);
  source.points_read = std::int64_t(map.occupied.size());
  source.voxels = RawVoxels{*geometry, std::move(occupied), BitGrid(map.size, false, true)};
  return success();
}

Status load_tree(Result<OcTreePtr> tree, MapSource& source) {
  if (!tree) return tree.error();
  source.tree = *tree;
  return success();
}

Status load_text(std::string_view bytes, const LoadOptions& options, MapSource& source) {
  if (bytes.starts_with("\xFF\xFE") || bytes.starts_with("\xFE\xFF")) {
    return malformed("it is UTF-16 text: save it as plain text (UTF-8)");
  }
  bytes = without_byte_order_mark(bytes);
  if (source.format == "3dmap") {
    const auto map = read_warframe(bytes);
    return map ? load_warframe(*map, options, source) : Status(map.error());
  }
  auto cloud = source.format == "pcd"   ? read_pcd(bytes)
               : source.format == "ply" ? read_ply(bytes)
                                        : read_obj(bytes);
  return cloud ? load_cloud(*std::move(cloud), options, source) : Status(cloud.error());
}

Status load_bytes(std::string_view bytes, const LoadOptions& options, MapSource& source) {
  if (bytes.empty()) return malformed("it is empty");
  if (source.format == "bt") return load_tree(read_bt(bytes), source);
  if (source.format == "ot") return load_tree(read_ot(bytes), source);
  if (source.format == "stl") {  // binary, as a rule: no text that a byte order mark begins
    auto mesh = read_stl(bytes);
    return mesh ? load_cloud(*std::move(mesh), options, source) : Status(mesh.error());
  }
  return load_text(bytes, options, source);
}

Error about(const std::string& path, Error error) {
  error.message = "the map '" + path + "' cannot be used: " + error.message;
  return error;
}

Status check_ending(const std::string& path) {
  const std::string ending = lower_case_ending(path);
  for (const std::string_view known : {"bt", "ot", "pcd", "ply", "stl", "obj", "3dmap"}) {
    if (ending == known) return success();
  }
  return about(path, fail(ErrorCode::map_unreadable,
                          "its name must end in .bt, .ot, .pcd, .ply, .stl, .obj or .3dmap"));
}

Error no_memory() {
  return fail(ErrorCode::map_too_large,
              "it does not fit into memory: give a smaller box, or a coarser resolution");
}

// On the same raster: both origins are multiples of the resolution.
Index3 steps_between(const GridGeometry& from, const GridGeometry& to) {
  const Vec3 steps = ((to.origin_map - from.origin_map) / from.resolution_m).array().round().matrix();
  return {int(steps.x()), int(steps.y()), int(steps.z())};
}

Result<RawVoxels> cut(const RawVoxels& voxels, const VoxelizeOptions& options) {
  const auto geometry =
      raster_of(*options.box, voxels.geometry.resolution_m, options.max_voxels);
  if (!geometry) return geometry.error();
  if (*geometry == voxels.geometry) return voxels;
  const Index3 lower = steps_between(voxels.geometry, *geometry);
  RawVoxels result{*geometry, BitGrid(geometry->size, true),
                   voxels.known.window(lower, geometry->size)};
  const BitGrid occupied = voxels.occupied.window(lower, geometry->size);
  // What lies outside the voxels read is unknown, and only what is known is occupied.
  for (int z = 0; z < geometry->size.z; ++z) {
    for (int y = 0; y < geometry->size.y; ++y) {
      BitGrid::Word* to = result.occupied.mutable_row(y, z);
      for (std::size_t w = 0; w < occupied.words_per_row(); ++w) {
        to[w] |= occupied.row(y, z)[w] & result.known.row(y, z)[w];
      }
    }
  }
  return result;
}

}  // namespace

Result<RawVoxels> voxelize(const MapSource& source, const VoxelizeOptions& options) try {
  if (!source.voxels) return voxelize(*source.tree, options);
  if (!options.box) return *source.voxels;
  return cut(*source.voxels, options);
} catch (const std::bad_alloc&) {
  return no_memory();
}

Result<MapSource> load_map_bytes(std::string_view bytes, const std::string& name,
                                 const LoadOptions& options) try {
  if (auto status = check_ending(name); !status) return status.error();
  MapSource source;
  source.format = lower_case_ending(name);
  if (auto status = load_bytes(bytes, options, source); !status) {
    return about(name, status.error());
  }
  return source;
} catch (const std::bad_alloc&) {
  return about(name, no_memory());
}

Result<MapSource> load_map(const std::string& path, const LoadOptions& options) try {
  if (auto status = check_ending(path); !status) return status.error();
  const auto bytes = read_bytes(path);
  if (!bytes) return about(path, bytes.error());
  return load_map_bytes(*bytes, path, options);
} catch (const std::bad_alloc&) {
  return about(path, no_memory());
}

Result<std::vector<Vec3>> load_points(const std::string& path) {
  const auto bytes = read_bytes(path);
  if (!bytes) return about(path, bytes.error());
  const std::string ending = lower_case_ending(path);
  if (ending != "pcd" && ending != "ply") {
    return about(path, fail(ErrorCode::map_unreadable, "its name must end in .pcd or .ply"));
  }
  const std::string_view text = without_byte_order_mark(*bytes);
  auto cloud = ending == "pcd" ? read_pcd(text) : read_ply(text);
  if (!cloud) return about(path, cloud.error());
  return std::move(cloud->points);
}

}  // namespace goshawk::map_server
