// Clouds and meshes as people have them: each kind of file that once misled, made small here.
#include <gmock/gmock.h>
#include <octomap/OcTree.h>

#include <cmath>

#include "goshawk/map_server/live_map.hpp"
#include "goshawk/map_server/map_file.hpp"
#include "scan_support.hpp"
#include "support.hpp"

namespace goshawk::map_server {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::is_occupied;

Result<MapSource> load(const std::string& name, const std::string& bytes,
                       const LoadOptions& options = {}) {
  return load_map_bytes(bytes, name, options);
}

bool is_free(const RawVoxels& voxels, const Vec3& p) {
  const auto voxel = voxels.geometry.index_of(p);
  return voxel && voxels.known.get(*voxel) && !voxels.occupied.get(*voxel);
}

bool is_unknown(const RawVoxels& voxels, const Vec3& p) {
  const auto voxel = voxels.geometry.index_of(p);
  return !voxel || !voxels.known.get(*voxel);
}

std::string pcd(const std::vector<Vec3>& points, const std::string& more = "",
                const std::string& type = "F") {
  std::string text = "VERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE " + type + " " + type + " " +
                     type + "\nCOUNT 1 1 1\nWIDTH " + std::to_string(points.size()) +
                     "\nHEIGHT 1\n" + more + "POINTS " + std::to_string(points.size()) +
                     "\nDATA ascii\n";
  for (const Vec3& p : points) {
    std::ostringstream line;
    line.precision(12);
    line << p.x() << " " << p.y() << " " << p.z() << "\n";
    text += line.str();
  }
  return text;
}

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
  const std::string wire = ply("element vertex 2\n" + kXyz +
                                   "element edge 1\nproperty int vertex1\nproperty int vertex2\n",
                               "0 0 0\n4 3 2\n0 1\n");
  const RawVoxels edge = voxelize(load("m.ply", wire).value()).value();
  for (double t = 0.01; t < 1.0; t += 0.02) EXPECT_TRUE(is_occupied(edge, t * Vec3(4, 3, 2)));

  const std::string wall = ply(
      "element vertex 3\n" + kXyz + "element face 1\nproperty list uchar int vertex_indices\n",
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
      {ply("element vertex 3\n" + kXyz + lists, "0 0 0\n1 1 nan\n2 2 2\n3 0 1 2\n"),
       "not finite"}};
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
      {"int.ply", ply("element vertex 3\nproperty int x\nproperty short y\nproperty uchar z\n",
                      body)}};
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

  std::string floats =
      "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nWIDTH 1\nHEIGHT 1\nDATA binary\n";
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
