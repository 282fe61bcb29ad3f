#include "goshawk/map_server/map_file.hpp"

#include <octomap/OcTree.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <new>

#include "readers.hpp"
#include "scan.hpp"
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
  if (error) return fail(ErrorCode::map_unreadable, "its size cannot be told: " + error.message());
  if (size > kMaxFileBytes) {
    return fail(ErrorCode::map_too_large, "it is larger than 4 GiB: cut it or coarsen it");
  }
  std::ifstream file(path, std::ios::binary);
  std::string bytes(std::size_t(size), '\0');
  if (!file || !file.read(bytes.data(), std::streamsize(size))) {
    return fail(ErrorCode::map_unreadable, "it cannot be read: check its permissions");
  }
  return bytes;
}

Status check(const LoadOptions& options) {
  const auto positive = [](double v) { return std::isfinite(v) && v > 0.0; };
  if (!positive(options.resolution_m) || !positive(options.max_range_m) ||
      !is_finite(options.sensor_origin_map)) {
    return fail(ErrorCode::invalid_parameter,
                "a cloud's resolution and range must be finite and above zero, its sensor's "
                "origin finite");
  }
  return success();
}

// Drops what is not finite or outside the box.
Points usable(const Points& points, const LoadOptions& options, MapSource& source) {
  source.points_read = std::int64_t(points.size());
  Points kept;
  kept.reserve(points.size());
  for (const Vec3& p : points) {
    if (!is_finite(p)) {
      ++source.points_not_finite;
    } else if (options.box && ((p.array() < options.box->lower_map.array()).any() ||
                               (p.array() >= options.box->upper_map.array()).any())) {
      ++source.points_outside;
    } else {
      kept.push_back(p);
    }
  }
  return kept;
}

Box box_around(const Points& points, double resolution_m) {
  Box box{points.front(), points.front()};
  for (const Vec3& p : points) {
    box.lower_map = box.lower_map.cwiseMin(p);
    box.upper_map = box.upper_map.cwiseMax(p);
  }
  // A point on a face belongs to the upper voxel: the box must reach beyond it.
  box.upper_map += Vec3::Constant(0.01 * resolution_m);
  return box;
}

Result<OcTreePtr> tree_of_points(const Points& points, const LoadOptions& options) {
  const auto geometry = raster_of(options.box.value_or(box_around(points, options.resolution_m)),
                                  options.resolution_m, options.max_voxels);
  if (!geometry) return geometry.error();
  BitGrid occupied(geometry->size, true);
  for (const Vec3& p : points) {
    if (const auto voxel = geometry->index_of(p)) occupied.set(*voxel, true);
  }
  if (options.cloud == CloudMeaning::map) return make_octree(*geometry, occupied, {});
  return make_octree(*geometry, occupied, occupied);
}

Result<OcTreePtr> tree_of_scan(const Points& points, const LoadOptions& options) {
  auto tree = std::make_shared<octomap::OcTree>(options.resolution_m);
  auto inserted = insert_scan(*tree, points, options.sensor_origin_map, options.max_range_m);
  if (!inserted) return inserted.error();
  if (tree->size() == 0) return fail(ErrorCode::map_empty, "the scan reaches no voxel");
  return tree;
}

Status load_cloud(const Points& all, const LoadOptions& options, MapSource& source) {
  if (auto status = check(options); !status) return status;
  const Points points = usable(all, options, source);
  if (points.empty()) {
    return fail(ErrorCode::map_empty,
                "none of its " + std::to_string(source.points_read) + " points can be used: " +
                    std::to_string(source.points_not_finite) + " are not finite, " +
                    std::to_string(source.points_outside) + " lie outside the box");
  }
  auto tree = options.cloud == CloudMeaning::scan ? tree_of_scan(points, options)
                                                  : tree_of_points(points, options);
  if (!tree) return tree.error();
  source.tree = *tree;
  return success();
}

Status load_warframe(const WarframeMap& map, const LoadOptions& options, MapSource& source) {
  if (auto status = check(options); !status) return status;
  const double res = options.resolution_m;
  const auto geometry = raster_of({Vec3::Zero(), res * Vec3(map.size.x, map.size.y, map.size.z)},
                                  res, options.max_voxels);
  if (!geometry) return geometry.error();
  BitGrid occupied(map.size, true);
  for (const Index3 i : map.occupied) occupied.set(i, true);
  source.points_read = std::int64_t(map.occupied.size());
  auto tree = make_octree(*geometry, occupied, {});
  if (!tree) return tree.error();
  source.tree = *tree;
  return success();
}

Status load_tree(Result<OcTreePtr> tree, MapSource& source) {
  if (!tree) return tree.error();
  source.tree = *tree;
  return success();
}

Status load_bytes(std::string_view bytes, const LoadOptions& options, MapSource& source) {
  if (bytes.empty()) return malformed("it is empty");
  if (source.format == "bt") return load_tree(read_bt(bytes), source);
  if (source.format == "ot") return load_tree(read_ot(bytes), source);
  if (source.format == "3dmap") {
    const auto map = read_warframe(bytes);
    return map ? load_warframe(*map, options, source) : Status(map.error());
  }
  const auto points = source.format == "pcd" ? read_pcd(bytes) : read_ply(bytes);
  return points ? load_cloud(*points, options, source) : Status(points.error());
}

Error about(const std::string& path, Error error) {
  error.message = "the map '" + path + "' cannot be used: " + error.message;
  return error;
}

Status check_ending(const std::string& path) {
  const std::string ending = lower_case_ending(path);
  for (const std::string_view known : {"bt", "ot", "pcd", "ply", "3dmap"}) {
    if (ending == known) return success();
  }
  return about(
      path, fail(ErrorCode::map_unreadable, "its name must end in .bt, .ot, .pcd, .ply or .3dmap"));
}

Error no_memory() {
  return fail(ErrorCode::map_too_large,
              "it does not fit into memory: give a smaller box, or a coarser resolution");
}

}  // namespace

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

}  // namespace goshawk::map_server
