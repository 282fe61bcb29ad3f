#include "goshawk/map_server/octree.hpp"

#include <gmock/gmock.h>
#include <octomap/OcTree.h>

#include <cmath>
#include <limits>
#include <sstream>

#include "goshawk/map_server/map_file.hpp"
#include "goshawk/map_server/voxel_map.hpp"
#include "goshawk/worlds/world.hpp"
#include "support.hpp"

namespace goshawk::map_server {
namespace {

using testing::Folder;

constexpr std::int64_t kMany = 1'000'000'000;

TEST(RasterOf, CoversTheBoxAndLiesOnMultiplesOfTheResolution) {
  const GridGeometry g =
      raster_of({Vec3(-0.41, 0.0, 0.39), Vec3(1.0, 0.2, 0.6)}, 0.2, kMany).value();
  EXPECT_TRUE(g.origin_map.isApprox(Vec3(-0.6, 0.0, 0.2)));
  EXPECT_EQ(g.size, (Index3{8, 1, 2}));
}

TEST(RasterOf, CornersOnTheRasterAddNoLayerWhateverTheRounding) {
  for (int i = 1; i < 300; ++i) {
    const double res = 0.1;
    const GridGeometry g =
        raster_of({Vec3::Constant(-0.1 * i), Vec3::Constant(0.1 * i)}, res, kMany).value();
    EXPECT_EQ(g.size, (Index3{2 * i, 2 * i, 2 * i}));
  }
}

TEST(RasterOf, RefusesBoxesThatHoldNothingOrTooMuch) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const Vec3 zero = Vec3::Zero();
  const Vec3 one = Vec3::Ones();
  EXPECT_EQ(raster_of({one, zero}, 0.1, kMany).code(), ErrorCode::invalid_parameter);
  EXPECT_EQ(raster_of({zero, zero}, 0.1, kMany).code(), ErrorCode::invalid_parameter);
  EXPECT_EQ(raster_of({zero, Vec3(1, nan, 1)}, 0.1, kMany).code(), ErrorCode::invalid_parameter);
  EXPECT_EQ(raster_of({zero, one}, 0.0, kMany).code(), ErrorCode::invalid_parameter);
  EXPECT_EQ(raster_of({zero, one}, nan, kMany).code(), ErrorCode::invalid_parameter);
  EXPECT_EQ(raster_of({zero, 1e300 * one}, 0.1, kMany).code(), ErrorCode::map_too_large);
  EXPECT_EQ(raster_of({zero, 1000 * one}, 0.1, kMany).code(), ErrorCode::map_too_large);
}

TEST(MakeOctree, HoldsExactlyTheBitsAtEveryVoxel) {
  Random random(11);
  for (int round = 0; round < 20; ++round) {
    const Index3 size{1 + random.below(70), 1 + random.below(40), 1 + random.below(40)};
    const BitGrid occupied = testing::random_blocks(size, true, 12, random);
    BitGrid known = testing::random_blocks(size, false, 30, random);
    known.set({0, 0, 0}, true);
    const Vec3 origin = 0.2 * Vec3(random.below(100) - 50, random.below(100) - 50, -7);
    const GridGeometry geometry{origin, 0.2, size};
    const OcTreePtr tree = make_octree(geometry, occupied, known).value();
    for (int z = 0; z < size.z; ++z) {
      for (int y = 0; y < size.y; ++y) {
        for (int x = 0; x < size.x; ++x) {
          const Vec3 p = geometry.center({x, y, z});
          const auto* node = tree->search(p.x(), p.y(), p.z());
          ASSERT_EQ(node != nullptr, known.get({x, y, z}));
          if (node != nullptr) {
            ASSERT_EQ(tree->isNodeOccupied(node), occupied.get({x, y, z}));
          }
        }
      }
    }
  }
}

TEST(MakeOctree, LeavesTheTreeAsSmallAsOctoMapWouldPruneIt) {
  Random random(12);
  const Index3 size{64, 64, 32};
  const BitGrid occupied = testing::random_blocks(size, true, 10, random);
  const OcTreePtr tree = make_octree({Vec3::Zero(), 0.1, size}, occupied, {}).value();
  const std::size_t before = tree->size();
  tree->prune();
  EXPECT_EQ(tree->size(), before);
}

TEST(MakeOctree, RefusesWhatATreeCannotHold) {
  const BitGrid bits({2, 2, 2}, true);
  EXPECT_EQ(make_octree({Vec3(0.05, 0, 0), 0.1, {2, 2, 2}}, bits, {}).code(),
            ErrorCode::invalid_parameter);
  EXPECT_EQ(make_octree({Vec3(1e6, 0, 0), 0.1, {2, 2, 2}}, bits, {}).code(),
            ErrorCode::map_too_large);
  EXPECT_EQ(make_octree({Vec3(3276.7, 0, 0), 0.1, {2, 2, 2}}, bits, {}).code(),
            ErrorCode::map_too_large);
  EXPECT_EQ(make_octree({Vec3::Zero(), 0.1, {3, 2, 2}}, bits, {}).code(), ErrorCode::invalid_input);
  EXPECT_EQ(make_octree({Vec3::Zero(), 0.1, {2, 2, 2}}, bits, BitGrid({2, 2, 2}, false)).code(),
            ErrorCode::map_empty);
}

TEST(SaveVoxels, WorldsComeBackBitForBitFromBothKindsOfFile) {
  const Folder folder;
  for (const std::string& kind : worlds::world_kinds()) {
    for (const std::string ending : {".bt", ".ot"}) {
      worlds::WorldSpec spec = worlds::default_world();
      spec.kind = kind;
      const worlds::World world = worlds::make_world(spec).value();
      const std::string path = folder.file(kind + ending);
      ASSERT_TRUE(save_voxels(world.geometry, world.occupied, {}, path));
      const MapSource source = load_map(path).value();
      const RawVoxels raw = voxelize(source).value();
      EXPECT_EQ(raw.occupied, world.occupied) << kind << ending;
      EXPECT_EQ(raw.known.count(), raw.known.voxels());
      EXPECT_TRUE(raw.geometry.origin_map.isApprox(world.geometry.origin_map));
      EXPECT_EQ(raw.geometry.resolution_m, world.geometry.resolution_m);
    }
  }
}

TEST(SaveVoxels, OctoMapItselfReadsTheFile) {
  const Folder folder;
  const worlds::World world = worlds::make_world(worlds::default_world()).value();
  const std::string path = folder.file("world.bt");
  ASSERT_TRUE(save_voxels(world.geometry, world.occupied, {}, path));
  octomap::OcTree tree(1.0);
  ASSERT_TRUE(tree.readBinary(path));
  EXPECT_DOUBLE_EQ(tree.getResolution(), 0.2);
  std::int64_t occupied = 0;
  for (auto leaf = tree.begin_leafs(); leaf != tree.end_leafs(); ++leaf) {
    const std::int64_t side = std::lround(leaf.getSize() / 0.2);
    if (tree.isNodeOccupied(*leaf)) occupied += side * side * side;
  }
  EXPECT_EQ(occupied, world.occupied.count());
}

TEST(SaveVoxels, FailuresNameTheFile) {
  const BitGrid bits({2, 2, 2}, true);
  const GridGeometry geometry{Vec3::Zero(), 0.1, {2, 2, 2}};
  const Status nowhere = save_voxels(geometry, bits, {}, "/no/such/folder/map.bt");
  EXPECT_EQ(nowhere.code(), ErrorCode::io_failed);
  EXPECT_THAT(nowhere.error().message, ::testing::HasSubstr("/no/such/folder/map.bt"));
  EXPECT_EQ(save_voxels(geometry, bits, {}, "map.png").code(), ErrorCode::map_unreadable);
}

TEST(BinaryPayload, IsWhatOctoMapReadsAfterTheHeader) {
  const worlds::World world = worlds::make_world(worlds::default_world()).value();
  const OcTreePtr tree = make_octree(world.geometry, world.occupied, {}).value();
  std::istringstream stream(binary_payload(*tree));
  octomap::OcTree other(0.2);
  other.readBinaryData(stream);
  EXPECT_EQ(voxelize(other).value().occupied, world.occupied);
}

TEST(ReadBinaryPayload, GivesBackTheTreeThatWasWritten) {
  const worlds::World world = worlds::make_world(worlds::default_world()).value();
  const OcTreePtr tree = make_octree(world.geometry, world.occupied, {}).value();
  const auto again = read_binary_payload(binary_payload(*tree), 0.2);
  ASSERT_TRUE(again) << again.error().message;
  const RawVoxels voxels = voxelize(**again).value();
  EXPECT_EQ(voxels.geometry.size, world.geometry.size);
  EXPECT_EQ(voxels.occupied, world.occupied);
}

// Fifteen inner nodes along child 7 (all axes upwards), then one node of voxels at the upper end.
std::string corner_payload(unsigned leaf_bits) {
  std::string bytes;
  for (int level = 0; level < 15; ++level) bytes += std::string("\x00\xc0", 2);
  bytes += char(leaf_bits & 255U);
  bytes += char(leaf_bits >> 8U);
  return bytes;
}

TEST(ReadBinaryPayload, TellsOccupiedFromFreeAndUnknown) {
  // Child 0 is free, child 1 (x upwards) and child 6 (y and z upwards) are occupied.
  const auto tree = read_binary_payload(corner_payload(1U | 2U << 2U | 2U << 12U), 0.5);
  ASSERT_TRUE(tree) << tree.error().message;
  const RawVoxels voxels = voxelize(**tree).value();
  EXPECT_EQ(voxels.geometry.size, (Index3{2, 2, 2}));
  EXPECT_TRUE(voxels.geometry.origin_map.isApprox(Vec3::Constant(0.5 * 32766)));
  EXPECT_EQ(voxels.occupied.count(), 2);
  EXPECT_TRUE(voxels.occupied.test({1, 0, 0}) && voxels.occupied.test({0, 1, 1}));
  EXPECT_EQ(voxels.known.count(), 3);
  EXPECT_TRUE(voxels.known.test({0, 0, 0}));
}

TEST(ReadBinaryPayload, RefusesWhatIsNotOneWholeTree) {
  EXPECT_EQ(read_binary_payload("", 0.1).code(), ErrorCode::map_empty);
  EXPECT_EQ(read_binary_payload(std::string(2, '\0'), 0.1).code(), ErrorCode::map_empty);
  const std::string whole = corner_payload(2U);
  for (const double resolution_m : {0.0, -1.0, 1e-7, 1e4, std::nan("")}) {
    EXPECT_EQ(read_binary_payload(whole, resolution_m).code(), ErrorCode::map_malformed);
  }
  for (std::size_t k = 1; k < whole.size(); ++k) {
    EXPECT_EQ(read_binary_payload(whole.substr(0, k), 0.1).code(), ErrorCode::map_malformed) << k;
  }
  EXPECT_EQ(read_binary_payload(whole + " ", 0.1).code(), ErrorCode::map_malformed);
  EXPECT_EQ(read_binary_payload(std::string(100000, '\xff'), 0.1).code(), ErrorCode::map_malformed);
}

}  // namespace
}  // namespace goshawk::map_server
