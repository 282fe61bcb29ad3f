#include "goshawk/viewer_bridge/octomap_voxels.hpp"

#include <gtest/gtest.h>

#include "goshawk/core/random.hpp"

namespace goshawk::viewer_bridge {
namespace {

using Bytes = std::vector<std::uint8_t>;

void add_node(Bytes& bytes, unsigned bits) {
  bytes.push_back(std::uint8_t(bits & 255U));
  bytes.push_back(std::uint8_t(bits >> 8U));
}

// Fifteen inner nodes along child 7 (all axes upwards), then one node of voxels at the upper end.
Bytes corner_tree(unsigned leaf_bits) {
  Bytes bytes;
  for (int level = 0; level < 15; ++level) add_node(bytes, 3U << 14U);
  add_node(bytes, leaf_bits);
  return bytes;
}

TEST(OctomapVoxels, ReadsOccupiedAndFreeVoxels) {
  // Child 0 free, child 1 (x upwards) occupied, child 6 (y and z upwards) occupied.
  const auto grid = octomap_voxels(corner_tree(1U | 2U << 2U | 2U << 12U), 0.5);
  ASSERT_TRUE(grid) << grid.error().message;
  EXPECT_EQ(grid->geometry.size, (Index3{2, 2, 2}));
  EXPECT_TRUE(grid->geometry.origin_map.isApprox(Vec3::Constant(0.5 * 32766)));
  for (int x = 0; x < 2; ++x) {
    for (int y = 0; y < 2; ++y) {
      for (int z = 0; z < 2; ++z) {
        const bool wanted = (x == 1 && y == 0 && z == 0) || (x == 0 && y == 1 && z == 1);
        EXPECT_EQ(grid->grown.test({x, y, z}), wanted) << x << y << z;
      }
    }
  }
}

TEST(OctomapVoxels, FillsLargeLeaves) {
  Bytes bytes;
  for (int level = 0; level < 12; ++level) add_node(bytes, 3U << 14U);
  add_node(bytes, 2U);  // a leaf of 8 x 8 x 8 voxels
  const auto grid = octomap_voxels(bytes, 0.1);
  ASSERT_TRUE(grid);
  EXPECT_EQ(grid->geometry.size, (Index3{8, 8, 8}));
  EXPECT_TRUE(grid->grown.test({7, 7, 7}));
}

TEST(OctomapVoxels, NeitherCrashesNorHangsOnWhatIsNoTree) {
  EXPECT_EQ(octomap_voxels({}, 0.1).code(), ErrorCode::map_empty);
  EXPECT_EQ(octomap_voxels(corner_tree(2U), 0.0).code(), ErrorCode::invalid_input);
  EXPECT_EQ(octomap_voxels(Bytes(2, 0), 0.1).code(), ErrorCode::map_empty);
  EXPECT_EQ(octomap_voxels(Bytes(100000, 255), 0.1).code(), ErrorCode::invalid_input);
  const Bytes whole = corner_tree(2U);
  for (std::size_t k = 1; k < whole.size(); ++k) {
    EXPECT_FALSE(octomap_voxels(std::span(whole).first(k), 0.1)) << k;
  }
  Bytes huge;
  add_node(huge, 2U | 2U << 14U);  // two leaves of 32768 voxels a side
  EXPECT_EQ(octomap_voxels(huge, 0.1).code(), ErrorCode::map_too_large);
  Random random(1);
  for (int trial = 0; trial < 2000; ++trial) {
    Bytes bytes(64);
    for (auto& b : bytes) b = std::uint8_t(random.below(256));
    (void)octomap_voxels(bytes, 0.1);
  }
}

}  // namespace
}  // namespace goshawk::viewer_bridge
