#include "goshawk/map_server/voxel_map.hpp"

#include <fmt/format.h>
#include <octomap/OcTree.h>

#include <algorithm>
#include <limits>
#include <new>

#include "goshawk/core/inflation.hpp"
#include "growth.hpp"

namespace goshawk::map_server {
namespace {

constexpr int kOriginKey = 32768;
constexpr int kTreeDepth = 16;

struct KeyBox {
  Index3 lower;
  Index3 upper;  // exclusive

  bool holds(Index3 at, int side) const {
    return at.x >= lower.x && at.y >= lower.y && at.z >= lower.z && at.x + side <= upper.x &&
           at.y + side <= upper.y && at.z + side <= upper.z;
  }
  bool misses(Index3 at, int side) const {
    return at.x >= upper.x || at.y >= upper.y || at.z >= upper.z || at.x + side <= lower.x ||
           at.y + side <= lower.y || at.z + side <= lower.z;
  }
};

// Visits the leaves of a tree with their lower keys and sides, but skips what `skip` says.
// Twice as fast as OctoMap's iterators, and able to leave out whole branches.
template <typename Skip, typename Visit>
void for_leaves(const octomap::OcTree& tree, const octomap::OcTreeNode* node, Index3 at, int side,
                const Skip& skip, const Visit& visit) {
  if (skip(at, side)) return;
  if (!tree.nodeHasChildren(node)) return visit(*node, at, side);
  const int half = side / 2;
  for (unsigned i = 0; i < 8; ++i) {
    if (!tree.nodeChildExists(node, i)) continue;
    const Index3 child{at.x + (i & 1U ? half : 0), at.y + (i & 2U ? half : 0),
                       at.z + (i & 4U ? half : 0)};
    for_leaves(tree, tree.getNodeChild(node, i), child, half, skip, visit);
  }
}

template <typename Skip, typename Visit>
void for_leaves(const octomap::OcTree& tree, const Skip& skip, const Visit& visit) {
  if (tree.getRoot() != nullptr) {
    for_leaves(tree, tree.getRoot(), {0, 0, 0}, 1 << kTreeDepth, skip, visit);
  }
}

// In keys, not in metres: exact.
KeyBox bounds_of(const octomap::OcTree& tree) {
  constexpr int most = std::numeric_limits<int>::max();
  KeyBox box{{most, most, most}, {0, 0, 0}};
  const auto inside_already = [&](Index3 at, int side) { return box.holds(at, side); };
  for_leaves(tree, inside_already, [&](const octomap::OcTreeNode&, Index3 at, int side) {
    box.lower = {std::min(box.lower.x, at.x), std::min(box.lower.y, at.y),
                 std::min(box.lower.z, at.z)};
    box.upper = {std::max(box.upper.x, at.x + side), std::max(box.upper.y, at.y + side),
                 std::max(box.upper.z, at.z + side)};
  });
  return box;
}

Result<GridGeometry> geometry_of(const octomap::OcTree& tree, const VoxelizeOptions& options) {
  const double res = tree.getResolution();
  if (options.box) return raster_of(*options.box, res, options.max_voxels);
  const KeyBox keys = bounds_of(tree);
  if (keys.lower.x >= keys.upper.x) {
    return fail(ErrorCode::map_empty, "the map knows of no voxel: load one that holds something");
  }
  const auto metres = [&](Index3 key) -> Vec3 {
    return res * Vec3(key.x - kOriginKey, key.y - kOriginKey, key.z - kOriginKey);
  };
  return raster_of({metres(keys.lower), metres(keys.upper)}, res, options.max_voxels);
}

Index3 lower_key(const GridGeometry& geometry) {
  const Vec3 steps = (geometry.origin_map / geometry.resolution_m).array().round().matrix();
  return {int(steps.x()) + kOriginKey, int(steps.y()) + kOriginKey, int(steps.z()) + kOriginKey};
}

// One leaf: a cube of voxels, cut to the grid.
void fill(RawVoxels& raw, Index3 at, int side, bool occupied) {
  const Index3 n = raw.geometry.size;
  const int x0 = std::max(at.x, 0);
  const int x1 = std::min(at.x + side, n.x);
  if (x0 >= x1) return;
  for (int z = std::max(at.z, 0); z < std::min(at.z + side, n.z); ++z) {
    for (int y = std::max(at.y, 0); y < std::min(at.y + side, n.y); ++y) {
      raw.known.set_run(x0, x1, y, z, true);
      if (occupied) raw.occupied.set_run(x0, x1, y, z, true);
    }
  }
}

// Row by row: what grows under the policy. Padding bits of the result are undefined.
BitGrid::Word growing_word(BitGrid::Word occupied, BitGrid::Word known, UnknownPolicy policy) {
  return policy == UnknownPolicy::occupied ? occupied | ~known : occupied;
}

// What is added after the growth. Padding bits of the result are undefined.
BitGrid::Word finished_word(BitGrid::Word grown, BitGrid::Word known, UnknownPolicy policy) {
  return policy == UnknownPolicy::blocked ? grown | ~known : grown;
}

// make_voxel_grid without the demand that something stays free.
Result<VoxelGrid> grow(const RawVoxels& raw, const Growth& growth, std::uint64_t version) {
  // Word by word, in a copy that shares the chunks that do not change.
  const auto combine = [&](BitGrid& bits, auto&& rule) {
    for (int z = 0; z < raw.geometry.size.z; ++z) {
      for (int y = 0; y < raw.geometry.size.y; ++y) {
        BitGrid::Word* row = bits.mutable_row(y, z);
        const BitGrid::Word* known = raw.known.row(y, z);
        for (std::size_t i = 0; i < bits.words_per_row(); ++i) {
          row[i] = rule(row[i], known[i], growth.unknown);
        }
      }
    }
  };
  // Padding known = false makes ~known true there, which is the padding of `grown`.
  BitGrid growing = raw.occupied;
  if (growth.unknown == UnknownPolicy::occupied) combine(growing, growing_word);
  auto grown = inflate(growing, growth.inflation_m + growth.reserve_m, raw.geometry.resolution_m);
  if (!grown) return grown.error();
  if (growth.unknown == UnknownPolicy::blocked) combine(*grown, finished_word);
  return VoxelGrid{.geometry = raw.geometry,
                   .grown = *std::move(grown),
                   .known = raw.known,
                   .raw = raw.occupied,
                   .version = version,
                   .inflation_m = growth.inflation_m,
                   .unknown_is_occupied = growth.unknown != UnknownPolicy::free,
                   .unknown_grows = growth.unknown == UnknownPolicy::occupied};
}

}  // namespace

Result<RawVoxels> voxelize(const octomap::OcTree& tree, const VoxelizeOptions& options) try {
  const auto geometry = geometry_of(tree, options);
  if (!geometry) return geometry.error();
  RawVoxels raw{*geometry, BitGrid(geometry->size, true), BitGrid(geometry->size, false)};
  const Index3 origin = lower_key(*geometry);
  const KeyBox keys{origin, origin + geometry->size};
  const auto outside = [&](Index3 at, int side) { return keys.misses(at, side); };
  for_leaves(tree, outside, [&](const octomap::OcTreeNode& leaf, Index3 at, int side) {
    fill(raw, at - origin, side, tree.isNodeOccupied(leaf));
  });
  return raw;
} catch (const std::bad_alloc&) {
  return fail(ErrorCode::map_too_large,
              "the map's bits do not fit into memory: give a smaller box");
}

Error nothing_free(const Growth& growth) {
  return fail(ErrorCode::map_empty,
              fmt::format("no voxel of the map is free after obstacles were inflated by {:.3g} m "
                          "with unknown space {}: use a smaller radius or margin, or treat "
                          "unknown space as free",
                          growth.inflation_m + growth.reserve_m, to_word(growth.unknown)));
}

Result<VoxelGrid> make_voxel_grid(const RawVoxels& raw, const Growth& growth,
                                  std::uint64_t version) try {
  auto grid = grow(raw, growth, version);
  if (grid && grid->grown.count() == grid->grown.voxels()) {
    return nothing_free(growth);
  }
  return grid;
} catch (const std::bad_alloc&) {
  return fail(ErrorCode::map_too_large,
              "the grown map does not fit into memory: give a smaller box");
}

}  // namespace goshawk::map_server
