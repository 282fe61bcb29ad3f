// Meshes in STL and OBJ, and how a file is turned, thinned and described.
#include <gmock/gmock.h>

#include <cmath>
#include <cstring>
#include <numbers>

#include "goshawk/map_server/map_file.hpp"
#include "goshawk/map_server/map_summary.hpp"
#include "support.hpp"

namespace goshawk::map_server::mesh_files {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using testing::is_occupied;
using ::testing::IsEmpty;

std::string fault(const std::string& name, const std::string& bytes) {
  const auto source = load_map_bytes(bytes, name);
  if (source) return "read";
  EXPECT_EQ(source.code(), ErrorCode::map_malformed) << source.error().message;
  return source.error().message;
}

RawVoxels voxels_of(const std::string& name, const std::string& bytes,
                    const LoadOptions& options = {}) {
  const auto source = load_map_bytes(bytes, name, options);
  EXPECT_TRUE(source) << source.error().message;
  return voxelize(source.value()).value();
}

// A wall of two triangles at x = 2.1, from (0, 0) to (4, 2) in y and z.
const std::vector<std::array<Vec3, 3>> kWall{{Vec3(2.1, 0, 0), Vec3(2.1, 4, 0), Vec3(2.1, 4, 2)},
                                             {Vec3(2.1, 0, 0), Vec3(2.1, 4, 2), Vec3(2.1, 0, 2)}};

void expect_wall(const RawVoxels& voxels) {
  for (double y = 0.1; y < 4.0; y += 0.2) {
    for (double z = 0.1; z < 2.0; z += 0.2) {
      ASSERT_TRUE(is_occupied(voxels, {2.1, y, z})) << y << " " << z;
    }
  }
  EXPECT_EQ(voxels.geometry.size.x, 1);
}

std::string text_stl() {
  std::string text = "solid wall by hand\n";
  for (const auto& triangle : kWall) {
    text += "  facet normal 1 0 0\n    outer loop\n";
    for (const Vec3& p : triangle) {
      text += "      vertex " + std::to_string(p.x()) + " " + std::to_string(p.y()) + " " +
              std::to_string(p.z()) + "\n";
    }
    text += "    endloop\n  endfacet\n";
  }
  return text + "endsolid wall\n";
}

std::string binary_stl(const std::string& title) {
  std::string bytes = title;
  bytes.resize(80, '\0');
  const auto add = [&](const auto value) {
    bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
  };
  add(std::uint32_t(kWall.size()));
  for (const auto& triangle : kWall) {
    for (const float n : {1.F, 0.F, 0.F}) add(n);
    for (const Vec3& p : triangle) {
      for (int axis = 0; axis < 3; ++axis) add(float(p[axis]));
    }
    add(std::uint16_t{0});
  }
  return bytes;
}

TEST(Stl, TextAndBinaryAreTheSameWall) {
  expect_wall(voxels_of("w.stl", text_stl()));
  expect_wall(voxels_of("w.STL", binary_stl("made by a program")));
  expect_wall(voxels_of("w.stl", binary_stl("solid begins binary files of some programs")));
}

TEST(Stl, WhatCannotBeReadWholeIsRefused) {
  const std::string binary = binary_stl("x"), text = text_stl();
  EXPECT_THAT(fault("w.stl", binary.substr(0, binary.size() - 1)),
              AllOf(HasSubstr("promises 2 triangles"), HasSubstr("room for 1")));
  EXPECT_THAT(fault("w.stl", binary.substr(0, 40)), HasSubstr("shorter than the header"));
  EXPECT_THAT(fault("w.stl", text.substr(0, text.size() - 15)), HasSubstr("endsolid"));
  std::string wrong = text;
  wrong.replace(wrong.find("vertex 2.1"), 10, "vertex 2,1");
  EXPECT_THAT(fault("w.stl", wrong), HasSubstr("line 4 is not 'vertex X Y Z'"));
  wrong = text;
  wrong.erase(wrong.find("      vertex"), 42);
  EXPECT_THAT(fault("w.stl", wrong), HasSubstr("2 corners, not 3"));
  std::string nan = binary;
  const float value = std::nanf("");
  std::memcpy(nan.data() + 84 + 12, &value, sizeof value);
  EXPECT_THAT(fault("w.stl", nan), HasSubstr("not finite"));
}

const std::string kVertices = "v 2.1 0 0\nv 2.1 4 0 1.0\nv 2.1 4 2\nv 2.1 0 2 0.5 0.5 0.5\n";

TEST(Obj, FacesOfAllNotationsAreTheSameWall) {
  for (const std::string faces : {"f 1 2 3 4\n", "f 1/1/1 2/2/1 3/3/1\nf 1//1 3//1 4//1\n",
                                  "f -4 -3 -2\nf -4 -2 -1\n", "f 1 2 \\\n  3 4\n"}) {
    SCOPED_TRACE(faces);
    expect_wall(voxels_of("w.obj", "# by hand\nmtllib a.mtl\no wall\n" + kVertices +
                                       "vn 1 0 0\nvt 0 0\nusemtl grey\ns off\n" + faces));
  }
}

TEST(Obj, LinesAreObstacles) {
  const RawVoxels voxels = voxels_of("w.obj", "v 0 0 0\nv 4 3 2\nv 4 0 2\nl 1 2 3\n");
  for (double t = 0.01; t < 1.0; t += 0.02) {
    EXPECT_TRUE(is_occupied(voxels, t * Vec3(4, 3, 2)));
    EXPECT_TRUE(is_occupied(voxels, Vec3(4, 3 * t, 2)));
  }
}

TEST(Obj, WhatCannotBeReadWholeIsRefused) {
  EXPECT_THAT(fault("w.obj", kVertices + "f 1 2 5\n"), HasSubstr("line 5 names the vertex '5'"));
  EXPECT_THAT(fault("w.obj", kVertices + "f 0 1 2\n"), HasSubstr("'0'"));
  EXPECT_THAT(fault("w.obj", kVertices + "f -5 1 2\n"), HasSubstr("'-5'"));
  EXPECT_THAT(fault("w.obj", kVertices + "f 1 2\n"), HasSubstr("too few"));
  EXPECT_THAT(fault("w.obj", "v 1 2\n"), HasSubstr("line 1 is not 'v X Y Z'"));
  EXPECT_THAT(fault("w.obj", kVertices + "cstype bezier\n"), HasSubstr("free-form"));
  EXPECT_THAT(fault("w.obj", "v 0 0 0\nv 1 1 1\nv nan 0 0\nf 1 2 3\n"), HasSubstr("not finite"));
  EXPECT_EQ(load_map_bytes("# nothing\n", "w.obj").code(), ErrorCode::map_empty);
}

TEST(Turn, AMeshWhoseYAxisPointsUpIsTurnedUpright) {
  LoadOptions options;
  options.turn_rad = Vec3(0.5 * std::numbers::pi, 0, 0);
  // The wall as a modeller has it: x to the right, y up, z towards the viewer.
  expect_wall(
      voxels_of("w.obj", "v 2.1 0 0\nv 2.1 0 -4\nv 2.1 2 -4\nv 2.1 2 0\nf 1 2 3 4\n", options));
}

TEST(Turn, ComesAfterTheScaleAndTheOrigin) {
  LoadOptions options;
  options.scale = 0.001;
  options.origin_file = Vec3(10, 20, 0);
  options.turn_rad = Vec3(0, 0, 0.5 * std::numbers::pi);
  const RawVoxels voxels = voxels_of("w.obj", "v 13100 20100 500\n", options);
  EXPECT_TRUE(is_occupied(voxels, {-0.1, 3.1, 0.5}));
  EXPECT_EQ(voxels.occupied.count(), 1);
}

std::string ply_of(const std::vector<Vec3>& points) {
  std::string text = "ply\nformat ascii 1.0\nelement vertex " + std::to_string(points.size()) +
                     "\nproperty float x\nproperty float y\nproperty float z\nend_header\n";
  for (const Vec3& p : points) {
    text +=
        std::to_string(p.x()) + " " + std::to_string(p.y()) + " " + std::to_string(p.z()) + "\n";
  }
  return text;
}

std::vector<Vec3> floor_of(double spacing_m) {
  std::vector<Vec3> points;
  for (int i = 0; i < 40; ++i) {
    for (int j = 0; j < 40; ++j)
      points.emplace_back(spacing_m * i + 0.05, spacing_m * j + 0.05, 0.1);
  }
  return points;
}

TEST(Outliers, AreLeftOutOnRequest) {
  std::vector<Vec3> points = floor_of(0.2);
  points.emplace_back(3.1, 3.1, 2.1);     // alone above the floor
  points.emplace_back(5000, 5000, 3000);  // a map around it would be too large
  LoadOptions options;
  options.drop_outliers = true;
  const auto source = load_map_bytes(ply_of(points), "f.ply", options);
  ASSERT_TRUE(source) << source.error().message;
  EXPECT_EQ(source->outliers, 2);
  EXPECT_EQ(voxelize(*source)->occupied.count(), 40 * 40);
  EXPECT_EQ(load_map_bytes(ply_of(points), "f.ply").code(), ErrorCode::map_too_large);
  // Of a mesh, a lonely corner may be a part of a wall.
  expect_wall(voxels_of("w.obj", kVertices + "f 1 2 3 4\n", options));
  options.cloud = CloudMeaning::scan;
  EXPECT_EQ(load_map_bytes(ply_of(points), "f.ply", options).code(), ErrorCode::invalid_parameter);
}

TEST(Notes, PointsFartherApartThanAVoxelAreSuspected) {
  const auto thin = load_map_bytes(ply_of(floor_of(0.5)), "f.ply");
  ASSERT_TRUE(thin);
  ASSERT_EQ(thin->notes.size(), 1U);
  EXPECT_THAT(thin->notes[0],
              AllOf(HasSubstr("100 % of its points"), HasSubstr("walls have holes")));
  EXPECT_THAT(load_map_bytes(ply_of(floor_of(0.2)), "f.ply")->notes, IsEmpty());
  LoadOptions coarse;
  coarse.resolution_m = 0.5;
  EXPECT_THAT(load_map_bytes(ply_of(floor_of(0.5)), "f.ply", coarse)->notes, IsEmpty());
}

TEST(Notes, AMapSmallerThanAVehicleIsSuspected) {
  const auto small = load_map_bytes(ply_of(floor_of(0.005)), "f.ply");  // in kilometres, perhaps
  ASSERT_TRUE(small);
  ASSERT_EQ(small->notes.size(), 1U);
  EXPECT_THAT(small->notes[0], HasSubstr("set cloud_scale"));
}

TEST(Summary, SaysWhatWasReadInNumbersThatCanBeCounted) {
  std::vector<Vec3> points = floor_of(0.2);
  points.emplace_back(std::nan(""), 0, 0);
  points.emplace_back(0.05, 0.05, 100);
  LoadOptions options;
  options.box = Box{Vec3(0, 0, 0), Vec3(8, 8, 0.4)};
  options.cloud = CloudMeaning::points;
  const auto source = load_map_bytes(ply_of(points), "f.ply", options);
  ASSERT_TRUE(source) << source.error().message;
  // 1600 points in as many voxels of 40 x 40 x 2.
  EXPECT_EQ(
      summarise(*source, voxelize(*source).value()),
      "ply, 1602 points, 1.0 an occupied voxel, 1 not finite, 1 outside the box: 8 x 8 x 0.4 m "
      "from (0.000, 0.000, 0.000) to (8.000, 8.000, 0.400), 50.0 % occupied, 0.0 % free, "
      "50.0 % unknown");
  const auto mesh = load_map_bytes(kVertices + "f 1 2 3 4\n", "w.obj");
  EXPECT_THAT(summarise(*mesh, voxelize(*mesh).value()),
              HasSubstr("obj, 4 points and 2 triangles: 0.2 x 4.2 x 2.2 m"));
}

}  // namespace
}  // namespace goshawk::map_server::mesh_files
