// Corridors in maps of real places (OctoMap files); skipped if the files are absent.

#include <gmock/gmock.h>
#include <octomap/octomap.h>

#include <cstdlib>
#include <filesystem>

#include "goshawk/corridor_builder/corridor_builder.hpp"
#include "support/corridor_checker.hpp"
#include "support/worlds.hpp"

namespace goshawk::corridor_builder {
namespace {

std::filesystem::path data_folder() {
  if (const char* folder = std::getenv("GOSHAWK_DATA")) return folder;
  return std::filesystem::path(GOSHAWK_REPOSITORY) / ".." / "shared" / "data";
}

// Occupied leaves, grown by one voxel; unknown counts as free here, so that there is room.
VoxelGrid load(const std::string& file) {
  octomap::OcTree tree(0.1);
  if (!tree.readBinary(file)) throw std::runtime_error("cannot read " + file);
  double x0, y0, z0, x1, y1, z1;
  tree.getMetricMin(x0, y0, z0);
  tree.getMetricMax(x1, y1, z1);
  const double r = tree.getResolution();
  const Vec3 origin(x0, y0, z0);
  const Vec3 size = ((Vec3(x1, y1, z1) - origin) / r).array().round();
  VoxelGrid grid =
      test_support::empty_world({int(size.x()), int(size.y()), int(size.z())}, r, origin);
  for (auto leaf = tree.begin_leafs(); leaf != tree.end_leafs(); ++leaf) {
    if (!tree.isNodeOccupied(*leaf)) continue;
    const double half = 0.5 * leaf.getSize();
    const Vec3 c(leaf.getX(), leaf.getY(), leaf.getZ());
    const Vec3 lo = ((c.array() - half - origin.array()) / r).round();
    const Vec3 hi = ((c.array() + half - origin.array()) / r).round();
    test_support::fill(grid, {int(lo.x()), int(lo.y()), int(lo.z())},
                       {int(hi.x()), int(hi.y()), int(hi.z())});
  }
  grid.grown = inflate(grid.grown, r, r).value();
  return grid;
}

class RealMap : public ::testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Corridor, RealMap, ::testing::Values("geb079.bt", "fr78.bt"));

TEST_P(RealMap, NoPolytopeCutsIntoAnObstacle) {
  const auto file = data_folder() / "octomap" / GetParam();
  if (!std::filesystem::exists(file)) {
    GTEST_SKIP() << "no map " << file << ": set GOSHAWK_DATA to the folder of real maps";
  }
  const VoxelGrid grid = load(file.string());
  Random random(1);
  for (const Generator generator : {Generator::ellipsoid, Generator::box}) {
    auto builder = std::move(CorridorBuilder::create({.generator = generator})).value();
    int corridors = 0;
    for (int k = 0; k < 150; ++k) {
      const auto path =
          test_support::random_free_path(grid, 3, 30.0 * grid.geometry.resolution_m, random);
      if (path.empty()) continue;
      const auto corridor = builder.build(grid, path);
      ASSERT_TRUE(corridor.ok()) << corridor.error().message;
      ASSERT_EQ(test_support::faults_of(*corridor, grid, path), "") << "path " << k;
      ++corridors;
    }
    EXPECT_GT(corridors, 100);
  }
}

}  // namespace
}  // namespace goshawk::corridor_builder
