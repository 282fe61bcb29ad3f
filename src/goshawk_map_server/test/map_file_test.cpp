#include "goshawk/map_server/map_file.hpp"

#include <gmock/gmock.h>
#include <liblzf/lzf.h>
#include <octomap/ColorOcTree.h>
#include <octomap/OcTree.h>

#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#include "goshawk/map_server/voxel_map.hpp"
#include "support.hpp"

namespace goshawk::map_server {
namespace {

using testing::Folder;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

const std::vector<Vec3>& some_points() {
  static const std::vector<Vec3> points{Vec3(0.1, 0.1, 0.1), Vec3(0.9, 0.5, 0.3),
                                        Vec3(-0.3, 1.1, 2.5)};
  return points;
}

template <typename T>
std::string raw(T value, bool big = false) {
  std::string bytes(sizeof value, '\0');
  std::memcpy(bytes.data(), &value, sizeof value);
  return big ? std::string(bytes.rbegin(), bytes.rend()) : bytes;
}

std::string pcd_header(const std::string& fields, const std::string& sizes, std::size_t points,
                       const std::string& encoding) {
  std::string types;
  std::string counts;
  for (std::size_t i = 0; i < (sizes.size() + 1) / 2; ++i) {
    types += " F";
    counts += " 1";
  }
  return "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS " + fields + "\nSIZE " +
         sizes + "\nTYPE" + types + "\nCOUNT" + counts + "\nWIDTH " + std::to_string(points) +
         "\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " + std::to_string(points) + "\nDATA " +
         encoding + "\n";
}

std::string pcd_ascii(const std::vector<Vec3>& points) {
  std::string text = pcd_header("intensity x y z", "4 4 4 4", points.size(), "ascii");
  for (const Vec3& p : points) {
    text += "7 " + std::to_string(p.x()) + " " + std::to_string(p.y()) + " " +
            std::to_string(p.z()) + "\n";
  }
  return text;
}

// x as a double, then something else, then z and y as floats: the reader must go by the header.
std::string pcd_binary(const std::vector<Vec3>& points) {
  std::string bytes = pcd_header("x ring z y", "8 4 4 4", points.size(), "binary");
  for (const Vec3& p : points) {
    bytes += raw(p.x()) + raw(1.0F) + raw(float(p.z())) + raw(float(p.y()));
  }
  return bytes;
}

std::string pcd_compressed(const std::vector<Vec3>& points) {
  std::string plain;
  for (int axis = 0; axis < 3; ++axis) {
    for (const Vec3& p : points) plain += raw(float(p[axis]));
  }
  for (std::size_t i = 0; i < points.size(); ++i) plain += raw(0.0F);
  std::string packed(plain.size() * 2 + 64, '\0');
  const unsigned size =
      lzf_compress(plain.data(), unsigned(plain.size()), packed.data(), unsigned(packed.size()));
  packed.resize(size);
  return pcd_header("x y z intensity", "4 4 4 4", points.size(), "binary_compressed") +
         raw(std::uint32_t(size)) + raw(std::uint32_t(plain.size())) + packed;
}

// Points among other things; faces have tests of their own (cloud_test.cpp).
std::string ply_header(const std::string& format, std::size_t points) {
  return "ply\nformat " + format +
         " 1.0\ncomment made by a test\nelement camera 2\n"
         "property list uchar int ids\nproperty char flag\nelement vertex " +
         std::to_string(points) +
         "\nproperty uchar red\nproperty double x\nproperty float y\nproperty float z\n"
         "element marker 1\nproperty list uchar int vertices\nend_header\n";
}

std::string ply_ascii(const std::vector<Vec3>& points) {
  std::string text = ply_header("ascii", points.size()) + "3 1 2 3 0\n0 1\n";
  for (const Vec3& p : points) {
    text += "255 " + std::to_string(p.x()) + " " + std::to_string(p.y()) + " " +
            std::to_string(p.z()) + "\n";
  }
  return text + "3 0 1 2\n";
}

std::string ply_binary(const std::vector<Vec3>& points, bool big) {
  std::string bytes = ply_header(big ? "binary_big_endian" : "binary_little_endian", points.size());
  bytes += raw(char(2)) + raw(std::int32_t(1), big) + raw(std::int32_t(2), big) + raw(char(0));
  bytes += raw(char(0)) + raw(char(1));
  for (const Vec3& p : points) {
    bytes += raw(char(9)) + raw(p.x(), big) + raw(float(p.y()), big) + raw(float(p.z()), big);
  }
  bytes += raw(char(2)) + raw(std::int32_t(0), big) + raw(std::int32_t(1), big);
  return bytes;
}

// Are exactly the points' voxels occupied?
void expect_points(const MapSource& source, const std::vector<Vec3>& points) {
  const RawVoxels voxels = voxelize(source).value();
  EXPECT_EQ(voxels.occupied.count(), std::int64_t(points.size()));
  for (const Vec3& p : points) {
    const auto voxel = voxels.geometry.index_of(p);
    ASSERT_TRUE(voxel) << to_text(p);
    EXPECT_TRUE(voxels.occupied.get(*voxel)) << to_text(p);
  }
}

TEST(LoadMap, ReadsTheSamePointsFromEveryKindOfCloud) {
  const Folder folder;
  const std::vector<std::pair<std::string, std::string>> files{
      {"ascii.pcd", pcd_ascii(some_points())},
      {"binary.PCD", pcd_binary(some_points())},
      {"compressed.pcd", pcd_compressed(some_points())},
      {"ascii.ply", ply_ascii(some_points())},
      {"little.ply", ply_binary(some_points(), false)},
      {"big.ply", ply_binary(some_points(), true)}};
  for (const auto& [name, bytes] : files) {
    SCOPED_TRACE(name);
    const auto source = load_map(folder.write(name, bytes));
    ASSERT_TRUE(source) << source.error().message;
    EXPECT_EQ(source->points_read, 3);
    expect_points(*source, some_points());
  }
}

TEST(LoadMap, CompressedCloudsWithRepeatsAreUnpacked) {
  const Folder folder;
  std::vector<Vec3> points(500, Vec3(1.1, 2.1, 0.1));  // LZF makes back references of these
  points[7] = Vec3(3.1, 0.3, 0.7);
  const std::string bytes = pcd_compressed(points);
  ASSERT_LT(bytes.size(), 1000U);
  const MapSource source = load_map(folder.write("c.pcd", bytes)).value();
  EXPECT_EQ(source.points_read, 500);
  expect_points(source, {points[0], points[7]});
}

TEST(LoadMap, PointsThatAreNotFiniteAreSkippedAndCounted) {
  const Folder folder;
  std::vector<Vec3> points = some_points();
  points.push_back(Vec3(kNan, 0, 0));
  points.push_back(Vec3(0, std::numeric_limits<double>::infinity(), 0));
  for (const auto& [name, bytes] :
       {std::pair{"a.pcd", pcd_ascii(points)}, std::pair{"b.pcd", pcd_binary(points)},
        std::pair{"c.ply", ply_ascii(points)}, std::pair{"d.ply", ply_binary(points, true)}}) {
    const auto source = load_map(folder.write(name, bytes));
    ASSERT_TRUE(source) << source.error().message;
    EXPECT_EQ(source->points_read, 5) << name;
    EXPECT_EQ(source->points_not_finite, 2) << name;
    expect_points(*source, some_points());
  }
}

TEST(LoadMap, CloudMeaningSaysWhatLiesBetweenThePoints) {
  const Folder folder;
  const std::string path = folder.write("a.pcd", pcd_ascii(some_points()));
  LoadOptions options;

  options.cloud = CloudMeaning::map;
  RawVoxels voxels = voxelize(load_map(path, options).value()).value();
  EXPECT_EQ(voxels.known.count(), voxels.known.voxels());

  options.cloud = CloudMeaning::points;
  voxels = voxelize(load_map(path, options).value()).value();
  EXPECT_EQ(voxels.known.count(), 3);
  EXPECT_EQ(voxels.occupied.count(), 3);

  options.cloud = CloudMeaning::scan;
  options.sensor_origin_map = Vec3(0.1, 1.1, 0.1);
  voxels = voxelize(load_map(path, options).value()).value();
  EXPECT_EQ(voxels.occupied.count(), 3);
  EXPECT_GT(voxels.known.count(), 10);
  const auto between = voxels.geometry.index_of(Vec3(0.1, 0.5, 0.1));  // on the first ray
  ASSERT_TRUE(between);
  EXPECT_TRUE(voxels.known.get(*between));
  EXPECT_FALSE(voxels.occupied.get(*between));
}

TEST(LoadMap, TheBoxCutsACloudAndBoundsTheMap) {
  const Folder folder;
  LoadOptions options;
  options.box = Box{Vec3(0, 0, 0), Vec3(2, 2, 2)};
  const MapSource source =
      load_map(folder.write("a.pcd", pcd_ascii(some_points())), options).value();
  EXPECT_EQ(source.points_outside, 1);
  const RawVoxels voxels = voxelize(source).value();
  EXPECT_EQ(voxels.geometry.size, (Index3{10, 10, 10}));
  EXPECT_EQ(voxels.occupied.count(), 2);
}

TEST(LoadMap, WarframeVoxelsStandWhereTheFileSays) {
  const Folder folder;
  const MapSource source =
      load_map(folder.write("m.3dmap", "voxel 5 6 7\r\n0 0 0\n4 5 6\n2 3 1\n")).value();
  const RawVoxels voxels = voxelize(source).value();
  EXPECT_EQ(voxels.geometry.size, (Index3{5, 6, 7}));
  EXPECT_EQ(voxels.occupied.count(), 3);
  EXPECT_EQ(voxels.known.count(), 5 * 6 * 7);
  EXPECT_TRUE(voxels.occupied.get({4, 5, 6}));
  EXPECT_TRUE(voxels.occupied.get({2, 3, 1}));
  EXPECT_EQ(voxels.geometry.resolution_m, 0.2);
}

TEST(LoadMap, ColouredTreesLoseOnlyTheirColours) {
  const Folder folder;
  octomap::ColorOcTree coloured(0.1);
  octomap::OcTree plain(0.1);
  Random random(3);
  for (int i = 0; i < 300; ++i) {
    const octomap::point3d p(float(random.uniform(-1, 1)), float(random.uniform(-1, 1)),
                             float(random.uniform(-1, 1)));
    const bool occupied = random.chance(0.4);
    coloured.updateNode(p, occupied);
    coloured.integrateNodeColor(p.x(), p.y(), p.z(), 255, std::uint8_t(i), 7);
    plain.updateNode(p, occupied);
  }
  coloured.updateInnerOccupancy();
  ASSERT_TRUE(coloured.write(folder.file("c.ot")));
  const RawVoxels a = voxelize(load_map(folder.file("c.ot")).value()).value();
  const RawVoxels b = voxelize(plain).value();
  EXPECT_EQ(a.occupied, b.occupied);
  EXPECT_EQ(a.known, b.known);
}

TEST(LoadMap, BadOptionsAreRefused) {
  const Folder folder;
  const std::string path = folder.write("a.pcd", pcd_ascii(some_points()));
  LoadOptions options;
  options.resolution_m = 0.0;
  EXPECT_EQ(load_map(path, options).code(), ErrorCode::invalid_parameter);
  options.resolution_m = kNan;
  EXPECT_EQ(load_map(path, options).code(), ErrorCode::invalid_parameter);
  options = {};
  options.cloud = CloudMeaning::scan;
  options.sensor_origin_map = Vec3(0, kNan, 0);
  EXPECT_EQ(load_map(path, options).code(), ErrorCode::invalid_parameter);
  options = {};
  options.box = Box{Vec3(1, 1, 1), Vec3(0, 0, 0)};
  EXPECT_FALSE(load_map(path, options));
  options = {};
  options.max_voxels = 10;
  EXPECT_EQ(load_map(path, options).code(), ErrorCode::map_too_large);
}

}  // namespace
}  // namespace goshawk::map_server
