// Clouds and meshes as people have them: each kind of file that once misled, made small here.
#include <gmock/gmock.h>
#include <octomap/OcTree.h>

#include <cmath>

#include "cloud_maker.hpp"
#include "goshawk/map_server/live_map.hpp"
#include "scan_support.hpp"

namespace goshawk::map_server {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::HasSubstr;
using testing::is_free;
using testing::is_occupied;
using testing::is_unknown;
using ::testing::IsEmpty;
using testing::load;
using testing::pcd;

std::string ply(const std::string& elements, const std::string& body) {
  return "ply\nformat ascii 1.0\n" + elements + "end_header\n" + body;
}

const std::string kXyz = "property float x\nproperty float y\nproperty float z\n";

// A wall of two triangles across a room of 4 x 4 x 2 m, at x = 2.1.
const std::string kCorners = "0 0 0\n4 4 2\n2.1 0 0\n2.1 4 0\n2.1 4 2\n2.1 0 2\n";

void expect_wall(const RawVoxels& voxels) {
  for (double y = 0.1; y < 4.0; y += 0.2) {
    for (double z = 0.1; z < 2.0; z += 0.2) {
      ASSERT_TRUE(is_occupied(voxels, {2.1, y, z})) << y << " " << z;
      ASSERT_TRUE(is_free(voxels, {1.9, y, z})) << y << " " << z;
    }
  }
}

TEST(Mesh, WallsOfTrianglesQuadsAndStripsAreObstacles) {
  const std::string vertices = "element vertex 6\n" + kXyz;
  const std::string lists = "property list uchar int vertex_indices\n";
  const std::pair<std::string, std::string> bodies[] = {
      {"element face 2\n" + lists, "3 2 3 4\n3 2 4 5\n"},
      {"element face 1\nproperty list uchar uint vertex_index\n", "4 2 3 4 5\n"},
      {"element tristrips 1\n" + lists, "7 0 0 -1 2 3 5 4\n"},
      {"element face 1\nproperty uchar red\n" + lists + "property uchar green\n",
       "7 4 2 3 4 5 9\n"}};
  for (const auto& [element, rows] : bodies) {
    SCOPED_TRACE(element);
    const auto source = load("m.ply", ply(vertices + element, kCorners + rows));
    ASSERT_TRUE(source) << source.error().message;
    EXPECT_GE(source->triangles_read, 2);
    expect_wall(voxelize(*source).value());
  }
}

TEST(Mesh, FacesBeforeTheirVerticesAndInBinaryAreRead) {
  std::string bytes =
      "ply\nformat binary_little_endian 1.0\nelement face 1\n"
      "property list uchar uchar vertex_indices\nelement vertex 6\n" +
      kXyz + "end_header\n";
  bytes += std::string("\x04\x02\x03\x04\x05", 5);
  for (const float v : {0.F, 0.F, 0.F, 4.F, 4.F, 2.F, 2.1F, 0.F, 0.F, 2.1F, 4.F, 0.F, 2.1F, 4.F,
                        2.F, 2.1F, 0.F, 2.F}) {
    bytes.append(reinterpret_cast<const char*>(&v), sizeof v);
  }
  const auto source = load("m.ply", bytes);
  ASSERT_TRUE(source) << source.error().message;
  expect_wall(voxelize(*source).value());
}

TEST(Mesh, EdgesAreObstaclesAndABoxCutsFacesWithoutCornersInIt) {
  const std::string wire = ply(
      "element vertex 2\n" + kXyz + "element edge 1\nproperty int vertex1\nproperty int vertex2\n",
      "0 0 0\n4 3 2\n0 1\n");
  const RawVoxels edge = voxelize(load("m.ply", wire).value()).value();
  for (double t = 0.01; t < 1.0; t += 0.02) EXPECT_TRUE(is_occupied(edge, t * Vec3(4, 3, 2)));

  const std::string wall =
      ply("element vertex 3\n" + kXyz + "element face 1\nproperty list uchar int vertex_indices\n",
          "5 -50 -50\n5 100 -50\n5 -50 100\n3 0 1 2\n");
  LoadOptions options;
  options.box = Box{Vec3(4, 1, 0), Vec3(6, 3, 2)};
  const RawVoxels cut = voxelize(load("m.ply", wall, options).value()).value();
  EXPECT_EQ(cut.occupied.count(), 10 * 10);
  EXPECT_TRUE(is_occupied(cut, {5.1, 2.1, 1.1}));
}

TEST(Mesh, WhatCannotBeReadWholeIsRefused) {
  const std::string vertices = "element vertex 6\n" + kXyz;
  const std::string lists = "element face 1\nproperty list uchar int vertex_indices\n";
  const std::pair<std::string, std::string> cases[] = {
      {ply(vertices + lists, kCorners + "3 2 3 6\n"), "names the vertex 6 of 6"},
      {ply(vertices + lists, kCorners + "3 2 3 -1\n"), "names the vertex -1"},
      {ply(vertices + lists, kCorners + "4 2 3 4\n"), "cut off"},
      {ply(vertices + lists, kCorners), "promises 1 rows of 'face'"},
      {ply(vertices + "element face 1\nproperty list uchar int corners\n", kCorners + "3 2 3 4\n"),
       "no list vertex_indices"},
      {ply("element vertex 3\n" + kXyz + lists, "0 0 0\n1 1 nan\n2 2 2\n3 0 1 2\n"), "not finite"}};
  for (const auto& [bytes, why] : cases) {
    const auto source = load("m.ply", bytes);
    ASSERT_FALSE(source) << why;
    EXPECT_EQ(source.code(), ErrorCode::map_malformed);
    EXPECT_THAT(source.error().message, HasSubstr(why));
  }
  LoadOptions scan;
  scan.cloud = CloudMeaning::scan;
  const auto source = load("m.ply", ply(vertices + lists, kCorners + "3 2 3 4\n"), scan);
  EXPECT_EQ(source.code(), ErrorCode::invalid_parameter);
}

TEST(Cloud, OldAndOddFormsOfTextAreRead) {
  const std::vector<Vec3> points{Vec3(0, 0, 0), Vec3(1, 1, 1), Vec3(5, 5, 3)};
  const std::string body = "0 0 0\n1 1 1\n5 5 3\n";
  std::string old_ends = ply("element vertex 3\n" + kXyz, body);
  std::ranges::replace(old_ends, '\n', '\r');
  std::string windows;
  for (const char c : pcd(points)) windows += c == '\n' ? std::string("\r\n") : std::string(1, c);
  std::string columns = pcd(points);
  columns.replace(columns.find("FIELDS"), 6, "COLUMNS");
  columns.replace(columns.find("0.7"), 3, ".5");
  columns.erase(columns.find("COUNT"), 12);
  const std::pair<std::string, std::string> files[] = {
      {"bom.pcd", "\xEF\xBB\xBF" + pcd(points)},
      {"bom.ply", "\xEF\xBB\xBF" + ply("element vertex 3\n" + kXyz, body)},
      {"columns.pcd", columns},
      {"windows.pcd", windows},
      {"cr.ply", old_ends},
      {"int.pcd", pcd(points, "", "I")},
      {"int.ply",
       ply("element vertex 3\nproperty int x\nproperty short y\nproperty uchar z\n", body)}};
  for (const auto& [name, bytes] : files) {
    SCOPED_TRACE(name);
    const auto source = load(name, bytes);
    ASSERT_TRUE(source) << source.error().message;
    const RawVoxels voxels = voxelize(*source).value();
    EXPECT_EQ(voxels.occupied.count(), 3);
    for (const Vec3& p : points) EXPECT_TRUE(is_occupied(voxels, p));
  }
}

TEST(Cloud, BinaryIntegersAreRead) {
  std::string bytes =
      "VERSION 0.7\nFIELDS x y z\nSIZE 2 1 8\nTYPE I U I\nWIDTH 2\nHEIGHT 1\nDATA binary\n";
  const auto add = [&](std::int16_t x, std::uint8_t y, std::int64_t z) {
    bytes.append(reinterpret_cast<const char*>(&x), 2);
    bytes.append(reinterpret_cast<const char*>(&y), 1);
    bytes.append(reinterpret_cast<const char*>(&z), 8);
  };
  add(-3, 200, -1);
  add(4, 197, 2);
  const RawVoxels voxels = voxelize(load("i.pcd", bytes).value()).value();
  EXPECT_TRUE(is_occupied(voxels, {-3, 200, -1}));
  EXPECT_TRUE(is_occupied(voxels, {4, 197, 2}));
}

TEST(Cloud, WhatIsWrongIsNamed) {
  const auto why = [](const std::string& name, const std::string& bytes) {
    const auto source = load(name, bytes);
    return source ? std::string("read") : source.error().message;
  };
  std::string comma = pcd({Vec3(1, 1, 1)});
  comma.replace(comma.rfind("1 1 1"), 5, "0,5 0,5 0,5");
  EXPECT_THAT(why("c.pcd", comma), HasSubstr("a decimal point instead of the comma"));
  EXPECT_THAT(why("z.pcd", pcd({})), HasSubstr("holds no points"));
  EXPECT_THAT(why("u.pcd", std::string("\xFF\xFE") + "V"), HasSubstr("UTF-16"));
  EXPECT_THAT(why("t.pcd", pcd({Vec3(1, 1, 1)}, "", "X")), HasSubstr("must be one number"));
}

std::vector<Vec3> room(const Vec3& at, const Vec3& size = Vec3(20, 20, 5)) {
  std::vector<Vec3> points;
  for (int i = 0; i <= 20; ++i) {
    for (int j = 0; j <= 20; ++j) {
      const double x = i / 20.0, y = j / 20.0;
      points.push_back(at + size.cwiseProduct(Vec3(x, y, 0)));
      points.push_back(at + size.cwiseProduct(Vec3(x, 0, y)));
    }
  }
  return points;
}

TEST(Cloud, AStrayPointFarAwayIsNamedAndDoesNotBreakTheMap) {
  std::vector<Vec3> points = room(Vec3::Zero());
  points.emplace_back(4000, 30, 2);
  LoadOptions options;
  options.resolution_m = 1.0;  // as far apart as its points
  const auto source = load("o.pcd", pcd(points), options);
  ASSERT_TRUE(source) << source.error().message;
  ASSERT_EQ(source->notes.size(), 1U);
  EXPECT_THAT(source->notes[0],
              AllOf(HasSubstr("1 of 883 points"), HasSubstr("(4000.000, 30.000, 2.000)"),
                    HasSubstr("(20.000, 20.000, 5.000)"), HasSubstr("use_box")));
  points.back() = Vec3(6000, 6000, 3000);
  const auto refused = load("o.pcd", pcd(points), options);
  EXPECT_EQ(refused.code(), ErrorCode::map_too_large);
  EXPECT_THAT(refused.error().message, AllOf(HasSubstr("(6000.000"), HasSubstr("use_box")));
  options.box = Box{Vec3(0, 0, 0), Vec3(21, 21, 6)};
  EXPECT_THAT(load("o.pcd", pcd(points), options)->notes, IsEmpty());
  options.box = {};
  EXPECT_THAT(load("o.pcd", pcd(room(Vec3::Zero())), options)->notes, IsEmpty());
}

TEST(Cloud, AFewPointsAboveAFloorAreNotStray) {
  std::vector<Vec3> points;
  for (int i = 0; i <= 40; ++i) {
    for (int j = 0; j <= 40; ++j) points.emplace_back(0.5 * i, 0.5 * j, 0.0);
  }
  points.emplace_back(0, 0, 5);
  points.emplace_back(20, 20, 5);
  LoadOptions options;
  options.resolution_m = 0.5;
  EXPECT_THAT(load("f.pcd", pcd(points), options)->notes, IsEmpty());
  points.emplace_back(10, 10, 300);
  const auto source = load("f.pcd", pcd(points), options);
  ASSERT_EQ(source->notes.size(), 1U);
  EXPECT_THAT(source->notes[0],
              AllOf(HasSubstr("1 of 1684 points"), HasSubstr("(20.000, 20.000, 5.000)")));
}

TEST(Cloud, AProjectedCloudWithAStrayPointNamesBoth) {
  std::vector<Vec3> points = room(Vec3(691000, 4532000, 100));
  points.emplace_back(0, 0, 0);
  const auto refused = load("u.pcd", pcd(points));
  EXPECT_EQ(refused.code(), ErrorCode::map_too_large);
  EXPECT_THAT(refused.error().message,
              AllOf(HasSubstr("1 of 883 points"), HasSubstr("cloud_origin_x_m to 691000"),
                    HasSubstr("cloud_origin_y_m to 4532000")));
}

TEST(Cloud, ProjectedCoordinatesNameTheOriginThatBringsThemHome) {
  const Vec3 at(691000, 4532000, 100);
  const auto refused = load("u.pcd", pcd(room(at)));
  EXPECT_EQ(refused.code(), ErrorCode::map_too_large);
  EXPECT_THAT(refused.error().message, AllOf(HasSubstr("cloud_origin_x_m to 691000"),
                                             HasSubstr("cloud_origin_y_m to 4532000")));
  LoadOptions options;
  options.origin_file = Vec3(691000, 4532000, 0);
  const auto source = load("u.pcd", pcd(room(at)), options);
  ASSERT_TRUE(source) << source.error().message;
  EXPECT_TRUE(is_occupied(voxelize(*source).value(), {10, 10, 100}));

  std::string floats = "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nWIDTH 1\nHEIGHT 1\nDATA binary\n";
  for (const float v : {691000.4F, 4532000.4F, 100.F}) {
    floats.append(reinterpret_cast<const char*>(&v), sizeof v);
  }
  EXPECT_THAT(load("f.pcd", floats, options)->notes, Contains(HasSubstr("in steps of 0.5 m")));
}

TEST(Cloud, MillimetresAreScaledOrSuspected) {
  const std::string bytes = pcd({Vec3(0, 0, 0), Vec3(5000, 5000, 3000)});
  const auto refused = load("m.pcd", bytes);
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().message, HasSubstr("cloud_scale to 0.001"));
  LoadOptions options;
  options.scale = 0.001;
  EXPECT_TRUE(is_occupied(voxelize(load("m.pcd", bytes, options).value()).value(), {5, 5, 3}));
}

// OctoMap's tree takes up to 70 bytes a voxel of a flat map: none is made, not even for a scan.
TEST(Cloud, AFlatOneTakesBitsAndNoTree) {
  LoadOptions options;
  options.resolution_m = 0.05;
  const std::string bytes = pcd({Vec3(0, 0, 0), Vec3(60, 60, 0), Vec3(30, 30, 0)});
  const auto source = load("f.pcd", bytes, options);
  ASSERT_TRUE(source) << source.error().message;
  EXPECT_EQ(source->tree, nullptr);
  const RawVoxels voxels = voxelize(*source).value();
  EXPECT_EQ(voxels.geometry.size, (Index3{1201, 1201, 1}));
  EXPECT_EQ(voxels.known.count(), voxels.known.voxels());
  LiveMap map = LiveMap::from_source(*source, {}, {UnknownPolicy::free, 0.0}).value();
  const VoxelGrid grid = map.grid();
  EXPECT_GT(binary_payload(grid.geometry, grid.raw, grid.known).value().size(), 1000U);
  const std::vector<Vec3> hit{Vec3(1, 1, 0)};
  EXPECT_TRUE(testing::insert(map, hit, Vec3(2, 2, 0), 10.0));
  EXPECT_LT(map.memory_bytes(), 50'000'000);
}

TEST(Cloud, ThinMapsAreBoundByWhatTheyTake) {
  LoadOptions options;
  options.max_voxels = 100'000;
  const std::string thin = pcd({Vec3(0, 0, 0), Vec3(0, 50, 50)});  // 1 x 251 x 251 voxels
  const auto refused = load("t.pcd", thin, options);
  EXPECT_EQ(refused.code(), ErrorCode::map_too_large);
  EXPECT_THAT(refused.error().message, HasSubstr("in rows of 1"));
  EXPECT_TRUE(load("t.pcd", pcd({Vec3(0, 0, 0), Vec3(50, 0, 50)}), options));
}

}  // namespace
}  // namespace goshawk::map_server
