// Where the sensor was: the pose in a file's head, and the rays of a scan that begin there.
#include <gmock/gmock.h>

#include "cloud_maker.hpp"

namespace goshawk::map_server {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::HasSubstr;
using testing::is_free;
using testing::is_occupied;
using testing::is_unknown;
using testing::load;
using testing::pcd;

TEST(Viewpoint, ATurnedPoseIsAppliedToThePoints) {
  std::vector<Vec3> square;
  for (int i = 0; i < 21; ++i) {
    for (int j = 0; j < 21; ++j) square.emplace_back(-1.0 + 0.1 * i, -1.0 + 0.1 * j, 0.0);
  }
  // A quarter turn about x, one metre along -y: a wall in the plane y = -1.
  const auto source = load("w.pcd", pcd(square, "VIEWPOINT 0 -1 0 0.7071 0.7071 0 0\n"));
  ASSERT_TRUE(source) << source.error().message;
  EXPECT_THAT(source->notes, Contains(HasSubstr("VIEWPOINT")));
  const RawVoxels voxels = voxelize(*source).value();
  for (double x = -0.9; x < 1.0; x += 0.2) {
    for (double z = -0.9; z < 1.0; z += 0.2) {
      ASSERT_TRUE(is_occupied(voxels, {x, -1.0, z}) || is_occupied(voxels, {x, -1.1, z}));
    }
  }
  EXPECT_LE(voxels.geometry.size.y, 2);

  LoadOptions as_map;
  as_map.frame = CloudFrame::map;
  EXPECT_TRUE(is_occupied(
      voxelize(load("w.pcd", pcd(square, "VIEWPOINT 0 -1 0 0.7071 0.7071 0 0\n"), as_map).value())
          .value(),
      {0.5, 0.5, 0.0}));
}

TEST(Viewpoint, OneThatIsOnlyMovedMustBeSaidOfAMap) {
  const std::string bytes = pcd({Vec3(1, 1, 1), Vec3(2, 2, 2)}, "VIEWPOINT 5 2 1 1 0 0 0\n");
  const auto refused = load("m.pcd", bytes);
  EXPECT_EQ(refused.code(), ErrorCode::invalid_parameter);
  EXPECT_THAT(refused.error().message, AllOf(HasSubstr("cloud_frame"), HasSubstr("(5.000")));
  LoadOptions options;
  options.frame = CloudFrame::map;
  EXPECT_TRUE(is_occupied(voxelize(load("m.pcd", bytes, options).value()).value(), {2, 2, 2}));
  options.frame = CloudFrame::sensor;
  EXPECT_TRUE(is_occupied(voxelize(load("m.pcd", bytes, options).value()).value(), {7, 4, 3}));
  EXPECT_TRUE(load("m.pcd", pcd({Vec3(1, 1, 1)}, "VIEWPOINT 0 0 0 1 0 0 0\n")));
  for (const auto* wrong : {"1 2 3", "0 0 0 0 0 0 0", "0 0 nan 1 0 0 0", "0 0 0 1 0 0 x"}) {
    const auto source =
        load("m.pcd", pcd({Vec3(1, 1, 1)}, "VIEWPOINT " + std::string(wrong) + "\n"));
    EXPECT_EQ(source.code(), ErrorCode::map_malformed) << wrong;
  }
}

TEST(Viewpoint, RaysOfAScanBeginThere) {
  std::vector<Vec3> wall;
  for (int y = 0; y <= 40; ++y) {
    for (int z = 0; z <= 20; ++z) wall.emplace_back(9.0, 0.1 * y, 0.1 * z);
  }
  LoadOptions options;
  options.cloud = CloudMeaning::scan;
  const std::string bytes = pcd(wall, "VIEWPOINT 5 2 1 1 0 0 0\n");
  RawVoxels voxels = voxelize(load("s.pcd", bytes, options).value()).value();
  EXPECT_TRUE(is_occupied(voxels, {9.05, 2.05, 1.05}));
  EXPECT_TRUE(is_free(voxels, {7.05, 2.05, 1.05}));
  for (const double x : {4.5, 3.0, 1.0, 0.1}) EXPECT_TRUE(is_unknown(voxels, {x, 2.0, 1.0}));
  options.frame = CloudFrame::sensor;
  voxels = voxelize(load("s.pcd", bytes, options).value()).value();
  EXPECT_TRUE(is_occupied(voxels, {14.05, 4.05, 2.05}));
  options.sensor_origin_map = Vec3(8.05, 2.05, 1.05);
  voxels = voxelize(load("s.pcd", bytes, options).value()).value();
  EXPECT_TRUE(is_unknown(voxels, {6.0, 2.0, 1.0}));
}

TEST(Scan, RaysThatEndOutsideTheBoxClearWhatTheySawInsideIt) {
  std::vector<Vec3> wall;
  for (int y = -30; y <= 30; ++y) {
    for (int z = -10; z <= 10; ++z) wall.emplace_back(9.05, 0.3 * y, 0.3 * z);
  }
  LoadOptions options;
  options.cloud = CloudMeaning::scan;
  options.resolution_m = 0.1;
  options.sensor_origin_map = Vec3(0.05, 0.05, 0.05);
  const RawVoxels whole = voxelize(load("s.pcd", pcd(wall), options).value()).value();
  const Box box{Vec3(-1, -2, -1), Vec3(5, 2, 1)};
  options.box = box;
  const auto source = load("s.pcd", pcd(wall), options).value();
  EXPECT_EQ(source.points_outside, std::int64_t(wall.size()));
  const RawVoxels cut = voxelize(source, {.box = box}).value();
  EXPECT_EQ(cut.occupied.count(), 0);
  std::int64_t known = 0;
  for (int k = 0; k < 60 * 40 * 20; ++k) {
    const Index3 i{k % 60, k / 60 % 40, k / 60 / 40};
    const Vec3 p = cut.geometry.center(i);
    const bool seen = is_free(whole, p);
    ASSERT_EQ(is_free(cut, p), seen) << to_text(p);
    known += seen;
  }
  EXPECT_GT(known, 3000);
  EXPECT_EQ(known, voxelize(source).value().known.count()) << "nothing outside the box";
}

// Its key is another than the sensor's, but in float its ray has no length.
TEST(Scan, APointThatIsAllButAtTheSensorIsLeftOut) {
  LoadOptions options;
  options.cloud = CloudMeaning::scan;
  const auto source =
      load("s.pcd", pcd({Vec3(-1e-30, -1e-35, -1e-35), Vec3(2.1, 0.1, 0.1)}), options);
  ASSERT_TRUE(source) << source.error().message;
  EXPECT_EQ(voxelize(*source).value().occupied.count(), 1);
}

TEST(Scan, ASensorOutsideTheBoxAndRaysThatMissItAreFine) {
  LoadOptions options;
  options.cloud = CloudMeaning::scan;
  options.sensor_origin_map = Vec3(-3.1, 0.1, 0.1);
  options.box = Box{Vec3(0, -1, -1), Vec3(4, 1, 1)};
  const RawVoxels voxels =
      voxelize(load("s.pcd", pcd({Vec3(8, 0.1, 0.1), Vec3(-3, 9, 0), Vec3(2.1, 0.5, 0.1)}), options)
                   .value(),
               {.box = options.box})
          .value();
  EXPECT_TRUE(is_free(voxels, {0.1, 0.1, 0.1}));
  EXPECT_TRUE(is_free(voxels, {3.9, 0.1, 0.1}));
  EXPECT_TRUE(is_occupied(voxels, {2.1, 0.5, 0.1}));
}

}  // namespace
}  // namespace goshawk::map_server
