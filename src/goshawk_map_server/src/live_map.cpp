#include "goshawk/map_server/live_map.hpp"

#include <octomap/OcTree.h>

#include "growth.hpp"
#include "regrow.hpp"
#include "scan.hpp"

namespace goshawk::map_server {
namespace {

// Writes into the bits what the tree changed its mind about, and marks what that may touch.
void take_changes(const octomap::OcTree& tree, const GridGeometry& geometry, BitGrid& raw_occupied,
                  BitGrid& all_known, UnknownPolicy policy, DirtyBricks& dirty) {
  const Vec3 steps = (geometry.origin_map / geometry.resolution_m).array().round().matrix();
  for (auto change = tree.changedKeysBegin(); change != tree.changedKeysEnd(); ++change) {
    const octomap::OcTreeKey& key = change->first;
    const Index3 voxel{int(key[0]) - 32768 - int(steps.x()), int(key[1]) - 32768 - int(steps.y()),
                       int(key[2]) - 32768 - int(steps.z())};
    const octomap::OcTreeNode* node = tree.search(key);
    if (node == nullptr || !all_known.contains(voxel)) continue;
    const bool occupied = tree.isNodeOccupied(node);
    const bool was_occupied = raw_occupied.get(voxel);
    const bool was_known = all_known.get(voxel);
    if (occupied == was_occupied && was_known) continue;
    const bool grew_before = was_occupied || (!was_known && policy == UnknownPolicy::occupied);
    raw_occupied.set(voxel, occupied);
    all_known.set(voxel, true);
    if (!was_known) dirty.mark_known(voxel);
    dirty.mark(voxel, occupied != grew_before);
  }
}

}  // namespace

LiveMap::LiveMap(OcTreePtr tree, BitGrid raw_occupied, VoxelGrid grid, const Growth& growth)
    : tree_(std::move(tree)),
      raw_occupied_(std::move(raw_occupied)),
      grid_(std::move(grid)),
      growth_(growth) {
  tree_->enableChangeDetection(true);
}

Result<LiveMap> LiveMap::from_source(MapSource source, const VoxelizeOptions& options,
                                     const Growth& growth) {
  auto raw = voxelize(*source.tree, options);
  if (!raw) return raw.error();
  auto grid = make_voxel_grid(*raw, growth, 1);
  if (!grid) return grid.error();
  return LiveMap(std::move(source.tree), std::move(raw->occupied), std::move(*grid), growth);
}

Result<LiveMap> LiveMap::unknown_space(const Box& box, double resolution_m, const Growth& growth,
                                       std::int64_t max_voxels) {
  const auto geometry = raster_of(box, resolution_m, max_voxels);
  if (!geometry) return geometry.error();
  RawVoxels raw{*geometry, BitGrid(geometry->size, true), BitGrid(geometry->size, false)};
  auto grid = grow(raw, growth, 1);
  if (!grid) return grid.error();
  return LiveMap(std::make_shared<octomap::OcTree>(resolution_m), std::move(raw.occupied),
                 std::move(*grid), growth);
}

Result<LiveMap::ScanResult> LiveMap::insert_scan(std::span<const Vec3> points_map,
                                                 const Vec3& sensor_origin_map,
                                                 double max_range_m) {
  tree_->resetChangeDetection();
  const auto left_out = map_server::insert_scan(*tree_, points_map, sensor_origin_map, max_range_m);
  if (!left_out) return left_out.error();

  DirtyBricks dirty(grid_.geometry.size, reach_of(growth_, grid_.geometry));
  take_changes(*tree_, grid_.geometry, raw_occupied_, grid_.known, growth_.unknown, dirty);

  ScanResult result;
  result.points_left_out = *left_out;
  result.update.from_version = grid_.version;
  result.update.to_version = grid_.version + 1;
  for (const Index3 index : dirty.bricks()) {
    Brick brick = regrow({grid_.geometry, raw_occupied_, grid_.known}, growth_, index);
    if (dirty.became_known(index) || !(brick == brick_of(grid_, index))) {
      result.update.bricks.push_back(brick);
    }
  }
  if (auto status = apply(grid_, result.update); !status) return status.error();
  return result;
}

}  // namespace goshawk::map_server
