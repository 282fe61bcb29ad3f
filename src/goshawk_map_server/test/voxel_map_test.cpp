#include "goshawk/map_server/voxel_map.hpp"

#include <gmock/gmock.h>
#include <octomap/OcTree.h>

#include <cmath>
#include <limits>

#include "goshawk/core/inflation.hpp"
#include "support.hpp"

namespace goshawk::map_server {
namespace {

RawVoxels random_raw(Random& random) {
  const Index3 size{1 + random.below(90), 1 + random.below(12), 1 + random.below(12)};
  RawVoxels raw{{Vec3::Zero(), 0.1, size},
                testing::random_bits(size, true, 0.03, random),
                testing::random_bits(size, false, 0.9, random)};
  for (int z = 0; z < size.z; ++z) {
    for (int y = 0; y < size.y; ++y) {
      for (int x = 0; x < size.x; ++x) {
        if (!raw.known.get({x, y, z})) raw.occupied.set({x, y, z}, false);
      }
    }
  }
  return raw;
}

// By the words of the definition (docs/method.md): the distance between two cubes is less than the
// radius.
bool near_by_definition(const RawVoxels& raw, Index3 a, Index3 b, double radius_m) {
  const double res = raw.geometry.resolution_m;
  const auto gap_m = [&](int i, int j) { return std::max(0, std::abs(i - j) - 1) * res; };
  const double dx = gap_m(a.x, b.x);
  const double dy = gap_m(a.y, b.y);
  const double dz = gap_m(a.z, b.z);
  return std::sqrt(dx * dx + dy * dy + dz * dz) < radius_m - 1e-9;
}

bool blocked_by_definition(const RawVoxels& raw, const Growth& growth, Index3 at) {
  const bool unknown_here = !raw.known.get(at);
  if (unknown_here && growth.unknown != UnknownPolicy::free) return true;
  if (raw.occupied.get(at)) return true;
  const double radius_m = growth.inflation_m + growth.reserve_m;
  const int reach = int(radius_m / raw.geometry.resolution_m) + 2;
  for (int z = at.z - reach; z <= at.z + reach; ++z) {
    for (int y = at.y - reach; y <= at.y + reach; ++y) {
      for (int x = at.x - reach; x <= at.x + reach; ++x) {
        const Index3 other{x, y, z};
        if (!raw.occupied.contains(other)) continue;
        const bool grows = raw.occupied.get(other) ||
                           (growth.unknown == UnknownPolicy::occupied && !raw.known.get(other));
        if (grows && near_by_definition(raw, at, other, radius_m)) return true;
      }
    }
  }
  return false;
}

BitGrid unknown_of(const VoxelGrid& grid) {
  const Index3 n = grid.geometry.size;
  BitGrid unknown(n, true);
  for (int k = 0; k < n.x * n.y * n.z; ++k) {
    const Index3 i{k % n.x, k / n.x % n.y, k / n.x / n.y};
    if (!grid.known.get(i)) unknown.set(i, true);
  }
  return unknown;
}

void merge(BitGrid& bits, const BitGrid& others) {
  const Index3 n = bits.size();
  for (int k = 0; k < n.x * n.y * n.z; ++k) {
    const Index3 i{k % n.x, k / n.x % n.y, k / n.x / n.y};
    if (others.get(i)) bits.set(i, true);
  }
}

TEST(MakeVoxelGrid, BlocksWhatTheDefinitionBlocksUnderEachPolicy) {
  Random random(21);
  for (int round = 0; round < 60; ++round) {
    const RawVoxels raw = random_raw(random);
    // Whole multiples of the resolution are where rounding would show.
    const double inflation_m = round % 2 == 0 ? 0.1 * random.below(4) : random.uniform(0.0, 0.35);
    const double reserve_m = round % 3 == 0 ? 0.1 * random.below(3) : 0.0;
    const Growth growth{UnknownPolicy(random.below(3)), inflation_m, reserve_m};
    const auto grid = make_voxel_grid(raw, growth, 7);
    if (!grid) {
      EXPECT_EQ(grid.code(), ErrorCode::map_empty);
      continue;
    }
    EXPECT_TRUE(grid->check());
    EXPECT_EQ(grid->version, 7U);
    EXPECT_EQ(grid->inflation_m, growth.inflation_m);
    EXPECT_EQ(grid->known, raw.known);
    EXPECT_TRUE(grid->grown.outside());
    const Index3 n = raw.geometry.size;
    for (int z = 0; z < n.z; ++z) {
      for (int y = 0; y < n.y; ++y) {
        for (int x = 0; x < n.x; ++x) {
          ASSERT_EQ(grid->grown.get({x, y, z}), blocked_by_definition(raw, growth, {x, y, z}))
              << to_word(growth.unknown) << " " << growth.inflation_m << " at "
              << to_text(Index3{x, y, z});
        }
      }
    }
    // Padding reads as occupied to code that scans whole words.
    EXPECT_EQ(BitGrid::from_words(n, true, grid->grown.to_words()).value().to_words(),
              grid->grown.to_words());
  }
}

TEST(MakeVoxelGrid, PoliciesAreOrderedFromStrictToLax) {
  Random random(22);
  for (int round = 0; round < 20; ++round) {
    const RawVoxels raw = random_raw(random);
    std::int64_t last = raw.geometry.size.x * raw.geometry.size.y * raw.geometry.size.z;
    for (const auto policy :
         {UnknownPolicy::occupied, UnknownPolicy::blocked, UnknownPolicy::free}) {
      const auto grid = make_voxel_grid(raw, {policy, 0.1}, 1);
      const std::int64_t blocked = grid ? grid->grown.count() : last;
      EXPECT_LE(blocked, last);
      last = blocked;
    }
  }
}

// What a receiver of a grid may rely on: from raw, known and the two flags follows what is blocked.
TEST(MakeVoxelGrid, BringsRawVoxelsFromWhichTheGrownOnesFollow) {
  Random random(23);
  for (int round = 0; round < 30; ++round) {
    const RawVoxels raw = random_raw(random);
    for (const auto policy :
         {UnknownPolicy::occupied, UnknownPolicy::blocked, UnknownPolicy::free}) {
      const auto grid = make_voxel_grid(raw, {policy, 0.1}, 5);
      if (!grid) continue;
      EXPECT_EQ(grid->raw, raw.occupied);
      const BitGrid unknown = unknown_of(*grid);
      BitGrid growing = grid->raw;
      if (grid->unknown_grows) merge(growing, unknown);
      BitGrid grown = inflate(growing, 0.1, raw.geometry.resolution_m).value();
      if (grid->unknown_is_occupied) merge(grown, unknown);
      EXPECT_EQ(grown, grid->grown);
    }
  }
}

TEST(MakeVoxelGrid, SaysWhereAPointIsUnknown) {
  RawVoxels raw{
      {Vec3::Zero(), 1.0, {8, 1, 1}}, BitGrid({8, 1, 1}, true), BitGrid({8, 1, 1}, false)};
  raw.known.set_run(0, 6, 0, 0, true);
  raw.occupied.set({0, 0, 0}, true);
  const VoxelGrid strict = make_voxel_grid(raw, {UnknownPolicy::occupied, 0.5}, 1).value();
  EXPECT_EQ(locate(strict, Vec3(0.5, 0.5, 0.5), Endpoint::start).code(), ErrorCode::start_occupied);
  EXPECT_EQ(locate(strict, Vec3(6.5, 0.5, 0.5), Endpoint::goal).code(), ErrorCode::goal_unknown);
  EXPECT_EQ(locate(strict, Vec3(5.5, 0.5, 0.5), Endpoint::goal).code(), ErrorCode::goal_occupied);
  EXPECT_TRUE(locate(strict, Vec3(3.5, 0.5, 0.5), Endpoint::goal));
  const VoxelGrid lax = make_voxel_grid(raw, {UnknownPolicy::free, 0.5}, 1).value();
  EXPECT_TRUE(locate(lax, Vec3(6.5, 0.5, 0.5), Endpoint::goal));
}

TEST(MakeVoxelGrid, BadInflationsAndWorldsWithoutFreeSpaceAreRefused) {
  Random random(23);
  const RawVoxels raw = random_raw(random);
  for (const double bad :
       {-0.1, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    EXPECT_EQ(make_voxel_grid(raw, {UnknownPolicy::free, bad}, 1).code(), ErrorCode::invalid_input);
  }
  EXPECT_EQ(make_voxel_grid(raw, {UnknownPolicy::occupied, 1e9}, 1).code(), ErrorCode::map_empty);
}

// The tree as OctoMap answers it, voxel by voxel.
TEST(Voxelize, SaysWhatTheTreeSaysForEveryVoxel) {
  Random random(24);
  for (int round = 0; round < 10; ++round) {
    octomap::OcTree tree(0.1);
    for (int i = 0; i < 60; ++i) {  // blobs, so that leaves of several sizes come about
      const Index3 at{random.below(40) - 20, random.below(40) - 20, random.below(40) - 20};
      const bool occupied = random.chance(0.5);
      const int side = 1 << random.below(4);
      for (int j = 0; j < side * side * side; ++j) {
        const octomap::OcTreeKey key(std::uint16_t(32768 + (at.x & ~7) + j % side),
                                     std::uint16_t(32768 + (at.y & ~7) + j / side % side),
                                     std::uint16_t(32768 + (at.z & ~7) + j / side / side));
        tree.setNodeValue(key, occupied ? 2.0F : -1.0F);
      }
    }
    tree.prune();
    VoxelizeOptions options;
    if (round % 2 == 1) options.box = Box{Vec3(-1.33, -0.9, -3.0), Vec3(1.0, 0.71, 0.5)};
    const RawVoxels raw = voxelize(tree, options).value();
    std::int64_t known = 0;
    for (int z = 0; z < raw.geometry.size.z; ++z) {
      for (int y = 0; y < raw.geometry.size.y; ++y) {
        for (int x = 0; x < raw.geometry.size.x; ++x) {
          const Vec3 p = raw.geometry.center({x, y, z});
          const auto* node = tree.search(p.x(), p.y(), p.z());
          known += node != nullptr ? 1 : 0;
          ASSERT_EQ(raw.known.get({x, y, z}), node != nullptr);
          ASSERT_EQ(raw.occupied.get({x, y, z}), node != nullptr && tree.isNodeOccupied(node));
        }
      }
    }
    // Without a box nothing that the tree knows is left out.
    if (!options.box) {
      std::int64_t leaves = 0;
      for (auto leaf = tree.begin_leafs(); leaf != tree.end_leafs(); ++leaf) {
        leaves += std::llround(std::pow(leaf.getSize() / 0.1, 3));
      }
      EXPECT_EQ(known, leaves);
    }
  }
}

TEST(Voxelize, AnEmptyTreeOrABadBoxIsRefused) {
  const octomap::OcTree nothing(0.1);
  EXPECT_EQ(voxelize(nothing).code(), ErrorCode::map_empty);
  VoxelizeOptions options;
  options.box = Box{Vec3::Ones(), Vec3::Zero()};
  EXPECT_EQ(voxelize(nothing, options).code(), ErrorCode::invalid_parameter);
}

}  // namespace
}  // namespace goshawk::map_server
