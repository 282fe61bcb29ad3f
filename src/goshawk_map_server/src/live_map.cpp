#include "goshawk/map_server/live_map.hpp"

#include <octomap/OcTree.h>

#include "growth.hpp"
#include "regrow.hpp"
#include "scan.hpp"

namespace goshawk::map_server {
namespace {

// Writes into the raw and known bits what the tree changed its mind about, and marks what that may
// touch.
void take_changes(const octomap::OcTree& tree, UnknownPolicy policy, VoxelGrid& grid,
                  DirtyBricks& dirty) {
  const GridGeometry& geometry = grid.geometry;
  const Vec3 steps = (geometry.origin_map / geometry.resolution_m).array().round().matrix();
  for (auto change = tree.changedKeysBegin(); change != tree.changedKeysEnd(); ++change) {
    const octomap::OcTreeKey& key = change->first;
    const Index3 voxel{int(key[0]) - 32768 - int(steps.x()), int(key[1]) - 32768 - int(steps.y()),
                       int(key[2]) - 32768 - int(steps.z())};
    const octomap::OcTreeNode* node = tree.search(key);
    if (node == nullptr || !grid.known.contains(voxel)) continue;
    const bool occupied = tree.isNodeOccupied(node);
    const bool was_occupied = grid.raw.get(voxel);
    const bool was_known = grid.known.get(voxel);
    if (occupied == was_occupied && was_known) continue;
    const bool grew_before = was_occupied || (!was_known && policy == UnknownPolicy::occupied);
    grid.raw.set(voxel, occupied);
    grid.known.set(voxel, true);
    dirty.mark(voxel, occupied != grew_before);
  }
}

}  // namespace

LiveMap::LiveMap(OcTreePtr tree, VoxelGrid grid, const Growth& growth,
                 std::int64_t max_tree_bytes)
    : tree_(std::move(tree)),
      grid_(std::move(grid)),
      max_tree_bytes_(max_tree_bytes),
      growth_(growth) {
  if (tree_ != nullptr) tree_->enableChangeDetection(true);
}

Result<LiveMap> LiveMap::from_source(MapSource source, const VoxelizeOptions& options,
                                     const Growth& growth, std::int64_t max_tree_bytes) {
  auto raw = voxelize(source, options);
  if (!raw) return raw.error();
  auto grid = make_voxel_grid(*raw, growth, 1);
  if (!grid) return grid.error();
  return LiveMap(std::move(source.tree), *std::move(grid), growth, max_tree_bytes);
}

Result<LiveMap> LiveMap::unknown_space(const Box& box, double resolution_m, const Growth& growth,
                                       std::int64_t max_voxels) {
  const auto geometry = raster_of(box, resolution_m, max_voxels);
  if (!geometry) return geometry.error();
  RawVoxels raw{*geometry, BitGrid(geometry->size, true), BitGrid(geometry->size, false)};
  auto grid = grow(raw, growth, 1);
  if (!grid) return grid.error();
  return LiveMap(std::make_shared<octomap::OcTree>(resolution_m), *std::move(grid), growth,
                 std::numeric_limits<std::int64_t>::max());
}

Status LiveMap::make_tree() {
  auto tree = make_octree(grid_.geometry, grid_.raw, grid_.known, max_tree_bytes_);
  if (!tree) return tree.error();
  tree_ = *std::move(tree);
  tree_->enableChangeDetection(true);
  return success();
}

Result<std::string> LiveMap::octomap_payload() const {
  if (tree_ != nullptr) return binary_payload(*tree_);
  return binary_payload(grid_.geometry, grid_.raw, grid_.known);
}

Result<LiveMap::ScanResult> LiveMap::insert_scan(std::span<const Vec3> points_map,
                                                 const Vec3& sensor_origin_map,
                                                 double max_range_m) {
  if (tree_ == nullptr) {
    if (auto status = make_tree(); !status) return status.error();
  }
  tree_->resetChangeDetection();
  const auto inserted = map_server::insert_scan(*tree_, points_map, sensor_origin_map, max_range_m);
  if (!inserted) return inserted.error();

  DirtyBricks dirty(grid_.geometry.size, reach_of(growth_, grid_.geometry));
  const VoxelGrid before = grid_;
  take_changes(*tree_, growth_.unknown, grid_, dirty);

  ScanResult result;
  result.points_left_out = inserted->left_out;
  result.update.from_version = grid_.version;
  result.update.to_version = grid_.version + 1;
  for (const Index3 index : dirty.bricks()) {
    Brick brick = regrow(grid_, growth_, index);
    if (!(brick == brick_of(before, index))) result.update.bricks.push_back(std::move(brick));
  }
  if (auto status = apply(grid_, result.update); !status) return status.error();
  return result;
}

}  // namespace goshawk::map_server
