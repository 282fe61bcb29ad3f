// The shared real maps, against what their README says of them.

#include <gmock/gmock.h>
#include <octomap/OcTree.h>

#include <algorithm>
#include <array>

#include "goshawk/map_server/live_map.hpp"
#include "support.hpp"

namespace goshawk::map_server {
namespace {

std::array<int, 3> sorted(Index3 i) {
  std::array<int, 3> sides{i.x, i.y, i.z};
  std::sort(sides.begin(), sides.end());
  return sides;
}

TEST(RealMap, Geb079HasTheVoxelsOfItsReadme) {
  GOSHAWK_NEED_DATA(path, "octomap/geb079.bt");
  const RawVoxels raw = voxelize(load_map(path).value()).value();
  EXPECT_EQ(raw.geometry.resolution_m, 0.08);
  EXPECT_EQ(raw.occupied.count(), 185673);
  EXPECT_EQ(raw.known.count(), 185673 + 950759);
  EXPECT_THAT(sorted(raw.geometry.size), ::testing::ElementsAre(39, 187, 487));
}

TEST(RealMap, Fr78HasTheVoxelsOfItsReadme) {
  GOSHAWK_NEED_DATA(path, "octomap/fr78.bt");
  const RawVoxels raw = voxelize(load_map(path).value()).value();
  EXPECT_EQ(raw.geometry.resolution_m, 0.05);
  EXPECT_EQ(raw.occupied.count(), 287664);
  EXPECT_NEAR(double(raw.known.count() - raw.occupied.count()), 2.61e6, 0.005e6);
  EXPECT_THAT(sorted(raw.geometry.size), ::testing::ElementsAre(94, 256, 280));
}

TEST(RealMap, EveryVoxelIsWhatOctoMapAnswers) {
  GOSHAWK_NEED_DATA(path, "octomap/geb079.bt");
  const MapSource source = load_map(path).value();
  const RawVoxels raw = voxelize(source).value();
  octomap::OcTree tree(0.1);
  ASSERT_TRUE(tree.readBinary(path));
  Random random(1);
  for (int i = 0; i < 200000; ++i) {
    const Index3 at{random.below(raw.geometry.size.x), random.below(raw.geometry.size.y),
                    random.below(raw.geometry.size.z)};
    const Vec3 p = raw.geometry.center(at);
    const auto* node = tree.search(p.x(), p.y(), p.z());
    ASSERT_EQ(raw.known.get(at), node != nullptr);
    ASSERT_EQ(raw.occupied.get(at), node != nullptr && tree.isNodeOccupied(node));
  }
}

TEST(RealMap, ALoadedMapIsWrittenAsTheSameBytes) {
  GOSHAWK_NEED_DATA(path, "octomap/geb079.bt");
  const testing::Folder folder;
  const MapSource source = load_map(path).value();
  const RawVoxels raw = voxelize(source).value();
  ASSERT_TRUE(save_voxels(raw.geometry, raw.occupied, raw.known, folder.file("again.bt")));
  const auto tree_bytes = [](const std::string& bytes) {
    return bytes.substr(bytes.find("\ndata\n"));
  };
  EXPECT_EQ(tree_bytes(testing::bytes_of(folder.file("again.bt"))),
            tree_bytes(testing::bytes_of(path)));
}

TEST(RealMap, WarframeMapsHaveTheirVoxels) {
  GOSHAWK_NEED_DATA(path, "warframe/Simple.3dmap");
  const RawVoxels raw = voxelize(load_map(path).value()).value();
  EXPECT_EQ(raw.geometry.size, (Index3{105, 132, 105}));
  EXPECT_EQ(raw.occupied.count(), 512);
  EXPECT_EQ(raw.known.count(), raw.known.voxels());
}

TEST(RealMap, TheLargeWarframeMapLoads) {
  GOSHAWK_NEED_DATA(path, "warframe/Complex.3dmap");
  const MapSource source = load_map(path).value();
  EXPECT_EQ(voxelize(source).value().occupied.count(), source.points_read);
}

TEST(RealMap, AutowareCloudHasItsValidPoints) {
  GOSHAWK_NEED_DATA(path, "clouds/autoware_test.pcd");
  const MapSource source = load_map(path).value();
  EXPECT_EQ(source.points_read, 65536);
  const RawVoxels raw = voxelize(source).value();
  EXPECT_GT(raw.occupied.count(), 1000);
  EXPECT_LE(raw.occupied.count(), 48049);
}

TEST(RealMap, PlyCloudHasItsPoints) {
  GOSHAWK_NEED_DATA(path, "clouds/small_gicp_source.ply");
  const MapSource source = load_map(path).value();
  EXPECT_EQ(source.points_read, 69792);
  EXPECT_GT(voxelize(source).value().occupied.count(), 1000);
}

}  // namespace
}  // namespace goshawk::map_server
