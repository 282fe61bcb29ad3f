// The small files that once failed or misled, as they were sent in. Without them (GOSHAWK_CASES, or
// the folder beside the data) the tests say so and skip; cloud_test.cpp makes the same kinds itself.
#include <gmock/gmock.h>
#include <octomap/OcTree.h>

#include "goshawk/map_server/map_file.hpp"
#include "support.hpp"

namespace goshawk::map_server {
namespace {

using ::testing::HasSubstr;
using testing::is_occupied;

std::string case_file(const std::string& name) {
  const char* folder = std::getenv("GOSHAWK_CASES");
  const char* data = std::getenv("GOSHAWK_DATA");
  for (const std::string& root : {std::string(folder != nullptr ? folder : ""),
                                  data != nullptr ? std::string(data) + "/../cases" : "",
                                  std::string(GOSHAWK_SOURCE_ROOT) + "/../shared/cases"}) {
    if (!root.empty() && std::filesystem::exists(root + "/" + name)) return root + "/" + name;
  }
  return {};
}

#define GOSHAWK_NEED_CASE(variable, name)                                                 \
  const std::string variable = case_file(name);                                           \
  if (variable.empty()) {                                                                 \
    GTEST_SKIP() << "the case " << (name) << " is not here: set GOSHAWK_CASES to its folder"; \
  }

TEST(SharedCase, TheMeshRoomHasItsWall) {
  GOSHAWK_NEED_CASE(file, "mesh_ply/mesh_room.ply");
  const RawVoxels voxels = voxelize(load_map(file).value()).value();
  for (double y = 0.1; y < 4.0; y += 0.1) {
    for (double z = 0.1; z < 3.0; z += 0.1) {
      ASSERT_TRUE(is_occupied(voxels, {2.5, y, z})) << y << " " << z;
    }
  }
}

TEST(SharedCase, TheWallStandsWhereItsViewpointPutsIt) {
  GOSHAWK_NEED_CASE(file, "pcd_viewpoint/wall_viewpoint.pcd");
  const RawVoxels voxels = voxelize(load_map(file).value()).value();
  for (double x = -0.9; x < 1.0; x += 0.1) {
    for (double z = -0.9; z < 1.0; z += 0.1) {
      ASSERT_TRUE(is_occupied(voxels, {x, -1.0, z}) || is_occupied(voxels, {x, -1.1, z}));
    }
  }
}

TEST(SharedCase, TheScanSeesNothingBehindItsSensor) {
  GOSHAWK_NEED_CASE(file, "pcd_viewpoint_scan/scan_from_5_2_1.pcd");
  LoadOptions options;
  options.cloud = CloudMeaning::scan;
  const RawVoxels voxels = voxelize(load_map(file, options).value()).value();
  for (const Vec3& p : {Vec3(4, 2, 1), Vec3(2, 1, 0.5), Vec3(0.5, 0.3, 0.2)}) {
    const auto voxel = voxels.geometry.index_of(p);
    EXPECT_TRUE(!voxel || !voxels.known.get(*voxel)) << to_text(p);
  }
  EXPECT_TRUE(is_occupied(voxels, {9.05, 2.05, 1.05}));
}

TEST(SharedCase, TheScanKeepsWhatItSawInItsBox) {
  GOSHAWK_NEED_CASE(file, "scan_box/scan.pcd");
  LoadOptions options;
  options.cloud = CloudMeaning::scan;
  const RawVoxels whole = voxelize(load_map(file, options).value()).value();
  options.box = Box{Vec3(0, -3, -2), Vec3(5, 3, 2)};
  const RawVoxels cut = voxelize(load_map(file, options).value(), {.box = options.box}).value();
  std::int64_t different = 0;
  const Index3 n = cut.geometry.size;
  for (int k = 0; k < n.x * n.y * n.z; ++k) {
    const Index3 i{k % n.x, k / n.x % n.y, k / n.x / n.y};
    const auto there = whole.geometry.index_of(cut.geometry.center(i));
    different += cut.known.get(i) != (there && whole.known.get(*there));
  }
  EXPECT_EQ(different, 0);
  EXPECT_GT(cut.known.count(), 1000);
}

TEST(SharedCase, TheFlatCloudTakesBitsOnly) {
  GOSHAWK_NEED_CASE(file, "flat_cloud/flat.pcd");
  LoadOptions options;
  options.resolution_m = 0.05;
  const MapSource source = load_map(file, options).value();
  EXPECT_EQ(source.tree, nullptr);
  EXPECT_EQ(voxelize(source).value().occupied.count(), 3);
}

TEST(SharedCase, TheOutlierIsNamed) {
  GOSHAWK_NEED_CASE(file, "outlier/outlier.pcd");
  const MapSource source = load_map(file).value();
  ASSERT_EQ(source.notes.size(), 1U);
  EXPECT_THAT(source.notes[0], HasSubstr("1 of 6564 points"));
}

TEST(SharedCase, TheProjectedCloudsNameTheirOrigin) {
  for (const std::string name : {"utm/utm_double.pcd", "utm/utm_float.pcd"}) {
    GOSHAWK_NEED_CASE(file, name);
    const auto refused = load_map(file);
    EXPECT_EQ(refused.code(), ErrorCode::map_too_large);
    EXPECT_THAT(refused.error().message, HasSubstr("cloud_origin_y_m to 4532000"));
    LoadOptions options;
    options.origin_file = Vec3(691000, 4532000, 100);
    EXPECT_GT(voxelize(load_map(file, options).value()).value().occupied.count(), 1000);
  }
}

TEST(SharedCase, VariantsAreReadOrRefusedForTheTrueReason) {
  const std::pair<const char*, const char*> cases[] = {
      {"pcd_variants/columns.pcd", ""},      {"pcd_variants/int_fields.pcd", ""},
      {"pcd_variants/organised_nan.pcd", ""}, {"pcd_variants/padding.pcd", ""},
      {"pcd_variants/comma.pcd", "comma"},   {"pcd_variants/unit_mm.pcd", "cloud_scale"},
      {"pcd_variants/bom.pcd", "cloud_scale"}, {"pcd_variants/zero_points.pcd", "no points"},
      {"ply_variants/cr_only.ply", ""},      {"ply_variants/double_colour.ply", ""},
      {"ply_variants/int_xyz.ply", ""},      {"ply_variants/list_in_vertex.ply", ""},
      {"ply_variants/nan.ply", ""},          {"ply_variants/unit_mm.ply", "cloud_scale"}};
  for (const auto& [name, why] : cases) {
    GOSHAWK_NEED_CASE(file, name);
    const auto source = load_map(file);
    EXPECT_EQ(source.ok(), *why == '\0') << name;
    const std::string said = source ? "" : source.error().message;
    EXPECT_THAT(said, HasSubstr(why)) << name;
  }
}

}  // namespace
}  // namespace goshawk::map_server
