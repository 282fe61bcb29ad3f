#include "goshawk/map_server/octree.hpp"

#include <fmt/format.h>
#include <octomap/OcTree.h>

#include <charconv>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "bt_encoder.hpp"
#include "text.hpp"

namespace goshawk::map_server {
namespace {

constexpr double kHalfKeys = 32768.0;  // an OcTree spans 65536 voxels, the origin in the middle
constexpr double kMostPadding = 8.0;   // bits for a voxel of max_voxels

Error too_large(const std::string& what) {
  return fail(ErrorCode::map_too_large, what);
}

Result<std::string> encode(const GridGeometry& geometry, const BitGrid& occupied,
                           const BitGrid& known) {
  if (auto status = geometry.check(); !status) return status.error();
  if (!(occupied.size() == geometry.size) || (!known.empty() && !(known.size() == geometry.size))) {
    return fail(ErrorCode::invalid_input, "the bits do not have the size of the geometry");
  }
  const Vec3 steps = geometry.origin_map / geometry.resolution_m;
  if (steps.cwiseAbs().maxCoeff() > kHalfKeys) {
    return too_large("the map's origin " + to_text(geometry.origin_map) +
                     " m is out of OctoMap's reach at this resolution");
  }
  const Vec3 rounded = steps.array().round().matrix();
  if ((steps - rounded).cwiseAbs().maxCoeff() > 1e-3) {
    return fail(ErrorCode::invalid_parameter,
                "the map's origin " + to_text(geometry.origin_map) +
                    " m must be a multiple of its resolution to be kept in an OctoMap file");
  }
  const Vec3 upper = rounded + Vec3(geometry.size.x, geometry.size.y, geometry.size.z);
  if (upper.maxCoeff() > kHalfKeys) {
    return too_large("the map reaches beyond OctoMap's 32768 voxels from the origin");
  }
  const auto key = [&](double v) { return int(v + kHalfKeys); };
  return encode_bt({key(rounded.x()), key(rounded.y()), key(rounded.z())}, occupied, known);
}

Error knows_nothing() {
  return fail(ErrorCode::map_empty, "the map knows of no voxel");
}

Status check_voxels(Index3 n, std::int64_t max_voxels) {
  const double limit = double(max_voxels);
  if (double(n.x) * n.y * n.z > limit) {
    return too_large(fmt::format("the map has {} voxels, more than the limit of {}: give a smaller "
                                 "box, a coarser resolution or a higher limit",
                                 to_text(n), max_voxels));
  }
  // Rows along x take whole words: a map that is thin in x takes up to 64 times its bits.
  const double padded = 64.0 * std::ceil(n.x / 64.0) * n.y * n.z;
  if (padded > kMostPadding * limit) {
    return too_large(fmt::format("the map has {} voxels in rows of {}, which take {:.0f} MB: give a "
                                 "smaller box, a coarser resolution or a higher limit",
                                 to_text(n), n.x, padded / 8e6));
  }
  return success();
}

// OctoMap's own writers chat on stderr, and cut the resolution to six digits.
std::string header(const std::string& kind, std::uint64_t nodes, double resolution_m) {
  char resolution[32];
  const auto end = std::to_chars(resolution, resolution + sizeof resolution, resolution_m);
  return "# Octomap OcTree " + kind +
         "\n# (feel free to add / change comments, but leave the first line as it is!)\n"
         "id OcTree\nsize " +
         std::to_string(nodes) + "\nres " + std::string(resolution, end.ptr) + "\ndata\n";
}

// A file that was there before stays until the new one is whole.
Status write_file(const std::string& path, const std::string& head, const std::string& body) {
  const std::string unfinished = path + ".part";
  std::ofstream file(unfinished, std::ios::binary);
  file << head << body;
  file.close();
  std::error_code error;
  if (file) std::filesystem::rename(unfinished, path, error);
  if (file && !error) return success();
  std::remove(unfinished.c_str());
  return fail(ErrorCode::io_failed, "cannot write '" + path +
                                        "': check that its folder exists, may be written to and "
                                        "has space left");
}

Status check_tree_ending(const std::string& path) {
  const std::string ending = lower_case_ending(path);
  if (ending == "bt" || ending == "ot") return success();
  return fail(ErrorCode::map_unreadable,
              "cannot write a map to '" + path + "': its name must end in .bt or .ot");
}

}  // namespace

Result<GridGeometry> raster_of(const Box& box, double resolution_m, std::int64_t max_voxels) {
  if (!(std::isfinite(resolution_m) && resolution_m > 0.0)) {
    return fail(ErrorCode::invalid_parameter,
                fmt::format("the map's resolution is {:g} m: it must be finite and above zero",
                            resolution_m));
  }
  const Vec3 lower = box.lower_map / resolution_m;
  const Vec3 upper = box.upper_map / resolution_m;
  if (!is_finite(lower) || !is_finite(upper) || !(upper.array() > lower.array()).all()) {
    return fail(ErrorCode::invalid_parameter,
                fmt::format("the map's box from {} to {} m holds nothing: the upper corner must lie "
                            "above the lower one, both finite",
                            to_text(box.lower_map), to_text(box.upper_map)));
  }
  if (lower.minCoeff() < -kHalfKeys || upper.maxCoeff() > kHalfKeys) {
    const Vec3 offset = 1000.0 * (box.lower_map / 1000.0).array().round().matrix();
    return too_large(fmt::format("the map reaches from {} to {} m, beyond OctoMap's 32768 voxels of "
                                 "{:g} m from the origin: give a smaller box or a coarser "
                                 "resolution, or subtract an offset as {:.0f}, {:.0f}, {:.0f} m "
                                 "from all coordinates",
                                 to_text(box.lower_map), to_text(box.upper_map), resolution_m,
                                 offset.x(), offset.y(), offset.z()));
  }
  // A corner on the raster, but for rounding, must not add a layer of voxels.
  const Eigen::Array3d lo = (lower.array() + 1e-6).floor();
  const Eigen::Array3d hi = (upper.array() - 1e-6).ceil().max(lo + 1.0);
  GridGeometry geometry;
  geometry.resolution_m = resolution_m;
  geometry.origin_map = lo.matrix() * resolution_m;
  geometry.size = {int(hi.x() - lo.x()), int(hi.y() - lo.y()), int(hi.z() - lo.z())};
  if (auto status = check_voxels(geometry.size, max_voxels); !status) return status.error();
  return geometry;
}

Result<OcTreePtr> make_octree(const GridGeometry& geometry, const BitGrid& occupied,
                              const BitGrid& known) {
  const auto payload = encode(geometry, occupied, known);
  if (!payload) return payload.error();
  if (payload->empty()) return knows_nothing();
  auto tree = std::make_shared<octomap::OcTree>(geometry.resolution_m);
  MemoryStream stream(*payload);
  tree->readBinaryData(stream);
  return tree;
}

Status save_octree(const octomap::OcTree& tree, const std::string& path) {
  if (auto status = check_tree_ending(path); !status) return status;
  if (lower_case_ending(path) == "bt") {
    return write_file(path, header("binary file", tree.size(), tree.getResolution()),
                      binary_payload(tree));
  }
  std::ostringstream body;
  if (tree.size() > 0) tree.writeData(body);
  return write_file(path, header("file", tree.size(), tree.getResolution()), std::move(body).str());
}

Status save_voxels(const GridGeometry& geometry, const BitGrid& occupied, const BitGrid& known,
                   const std::string& path) {
  if (auto status = check_tree_ending(path); !status) return status;
  if (lower_case_ending(path) == "bt") {  // needs no tree
    const auto payload = encode(geometry, occupied, known);
    if (!payload) return payload.error();
    if (payload->empty()) return knows_nothing();
    return write_file(path, header("binary file", count_nodes(*payload), geometry.resolution_m),
                      *payload);
  }
  const auto tree = make_octree(geometry, occupied, known);
  if (!tree) return tree.error();
  return save_octree(**tree, path);
}

Result<std::string> binary_payload(const GridGeometry& geometry, const BitGrid& occupied,
                                   const BitGrid& known) {
  return encode(geometry, occupied, known);
}

std::string binary_payload(const octomap::OcTree& tree) {
  std::ostringstream stream;
  if (tree.size() > 0) tree.writeBinaryData(stream);
  return std::move(stream).str();
}

}  // namespace goshawk::map_server
