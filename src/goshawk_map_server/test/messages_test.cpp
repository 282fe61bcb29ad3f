// Clouds and depth images as sensors send them: what is read, and what is refused with which words.
#include <gmock/gmock.h>

#include <cstring>
#include <limits>

#include "goshawk/map_server_messages/cloud.hpp"
#include "goshawk/map_server_messages/depth_image.hpp"
#include "goshawk/map_server_messages/octomap.hpp"
#include "goshawk/map_server_messages/transform.hpp"

namespace goshawk::map_server {
namespace {

using sensor_msgs::msg::CameraInfo;
using sensor_msgs::msg::Image;
using sensor_msgs::msg::PointCloud2;
using sensor_msgs::msg::PointField;
using ::testing::HasSubstr;

constexpr std::size_t kMostPoints = 1000;
constexpr std::uint8_t kInt16 = 3, kUint32 = 6, kFloat32 = 7, kFloat64 = 8;
const float kNan = std::numeric_limits<float>::quiet_NaN();

PointField field(const std::string& name, std::uint32_t offset, std::uint8_t type) {
  PointField f;
  f.name(name);
  f.offset(offset);
  f.datatype(type);
  f.count(1);
  return f;
}

template <typename T>
PointCloud2 cloud_of(const std::vector<T>& numbers, std::uint8_t type) {
  PointCloud2 m;
  m.header().stamp().sec(100);
  for (std::uint32_t axis = 0; axis < 3; ++axis) {
    m.fields().push_back(field(std::string(1, "xyz"[axis]), axis * std::uint32_t(sizeof(T)), type));
  }
  m.height(1);
  m.width(std::uint32_t(numbers.size() / 3));
  m.point_step(3 * sizeof(T));
  m.row_step(m.width() * m.point_step());
  m.data().resize(numbers.size() * sizeof(T));
  if (!numbers.empty()) std::memcpy(m.data().data(), numbers.data(), m.data().size());
  return m;
}

void expect_refused(const PointCloud2& m, const std::string& words) {
  SensorCloud cloud;
  const Status status = read_cloud(m, kMostPoints, cloud);
  ASSERT_FALSE(status) << words;
  EXPECT_EQ(status.code(), ErrorCode::invalid_input);
  EXPECT_THAT(status.error().message, HasSubstr(words));
}

TEST(Clouds, AreReadAsFloatOrDoubleAndMissingReturnsAreLeftOut) {
  SensorCloud cloud;
  ASSERT_TRUE(
      read_cloud(cloud_of<float>({1, 2, 3, kNan, 0, 0, 4, 5, 6}, kFloat32), kMostPoints, cloud));
  EXPECT_EQ(cloud.points, (std::vector{Vec3(1, 2, 3), Vec3(4, 5, 6)}));
  EXPECT_EQ(cloud.stamp_ns, 100'000'000'000);
  ASSERT_TRUE(read_cloud(cloud_of<double>({1, 2, 3}, kFloat64), kMostPoints, cloud));
  EXPECT_EQ(cloud.points, std::vector{Vec3(1, 2, 3)});
}

TEST(Clouds, OfZeroPointsSayNothing) {
  SensorCloud cloud;
  cloud.points.push_back(Vec3::Ones());
  EXPECT_TRUE(read_cloud(cloud_of<float>({}, kFloat32), kMostPoints, cloud));
  EXPECT_TRUE(cloud.points.empty());
  EXPECT_TRUE(read_cloud(PointCloud2(), kMostPoints, cloud));
}

TEST(Clouds, ThatAreOrganisedAreReadRowByRowOverTheirPadding) {
  PointCloud2 m = cloud_of<float>({1, 0, 0, 2, 0, 0, 9, 9, 9, 3, 0, 0, 4, 0, 0, 9, 9, 9}, kFloat32);
  m.height(2);
  m.width(2);
  m.row_step(36);  // a point of padding
  SensorCloud cloud;
  ASSERT_TRUE(read_cloud(m, kMostPoints, cloud));
  EXPECT_EQ(cloud.points,
            (std::vector{Vec3(1, 0, 0), Vec3(2, 0, 0), Vec3(3, 0, 0), Vec3(4, 0, 0)}));
}

TEST(Clouds, ThatDoNotFitAreRefusedWithTheirFault) {
  const PointCloud2 good = cloud_of<float>({1, 2, 3, 4, 5, 6}, kFloat32);
  PointCloud2 m = good;
  m.is_bigendian(true);
  expect_refused(m, "big-endian");
  expect_refused(cloud_of<std::int16_t>({100, 200, 300}, kInt16), "whole numbers");
  m = good;
  m.fields().pop_back();
  expect_refused(m, "no field 'z'");
  m = good;
  m.fields()[1].datatype(77);
  expect_refused(m, "'y' of an unknown type");
  m = good;
  m.fields()[2].offset(std::numeric_limits<std::uint32_t>::max());
  expect_refused(m, "beyond its point_step");
  m = good;
  m.data().pop_back();
  expect_refused(m, "brings 23 bytes");
  m = good;
  m.width(10'000'000);
  m.height(100'000'000);
  m.row_step(0xFFFFFFFF);
  expect_refused(m, "brings 24 bytes");
  m = good;
  m.point_step(8);
  expect_refused(m, "point_step of 8 bytes");
  expect_refused(cloud_of<float>(std::vector<float>(3 * (kMostPoints + 1), 1.0F), kFloat32),
                 "more than max_points");
}

TEST(Clouds, TimesFarFromTheStampAreRefused) {
  PointCloud2 m = cloud_of<std::uint32_t>({0, 0, 0, 0}, kFloat32);
  m.width(1);
  m.fields().push_back(field("t", 12, kUint32));
  m.point_step(16);
  m.row_step(16);
  const std::uint32_t late_ns = 2'000'000'000, early_ns = 50'000'000;
  std::memcpy(m.data().data() + 12, &late_ns, 4);
  expect_refused(m, "2 s away");
  std::memcpy(m.data().data() + 12, &early_ns, 4);
  SensorCloud cloud;
  ASSERT_TRUE(read_cloud(m, kMostPoints, cloud));
  EXPECT_EQ(cloud.offsets_ns, std::vector{std::int64_t{50'000'000}});
}

TEST(Clouds, InCoordinatesOfAMapProjectionAreRefusedWithTheOffsetToSubtract) {
  PointCloud2 m = cloud_of<float>({500010, 5000020, 100, 500020, 5000000, 90}, kFloat32);
  m.header().frame_id("map");
  expect_refused(m, "an offset as 500000, 5000000, 0 m");
  m.header().frame_id("lidar");  // odometry is double: a sensor's own frame is fine
  SensorCloud cloud;
  EXPECT_TRUE(read_cloud(m, kMostPoints, cloud));
  m = cloud_of<double>({500'010.25, 5'000'020, 100}, kFloat64);
  m.header().frame_id("map");
  ASSERT_TRUE(read_cloud(m, kMostPoints, cloud));
  EXPECT_EQ(cloud.points, std::vector{Vec3(500'010.25, 5'000'020, 100)});
  // One point that is far off is no projection.
  m = cloud_of<float>({1, 2, 3, 1e9F, 0, 0}, kFloat32);
  m.header().frame_id("map");
  EXPECT_TRUE(read_cloud(m, kMostPoints, cloud));
}

CameraInfo info(std::uint32_t width, std::uint32_t height) {
  CameraInfo m;
  m.header().frame_id("optical");
  m.width(width);
  m.height(height);
  m.k({50, 0, 1.5, 0, 40, 0.5, 0, 0, 1});
  return m;
}

template <typename Pixel>
Image image_of(const std::vector<Pixel>& pixels, const std::string& encoding) {
  Image m;
  m.header().stamp().sec(100);
  m.encoding(encoding);
  m.width(4);
  m.height(std::uint32_t(pixels.size() / 4));
  m.step(4 * sizeof(Pixel));
  m.data().resize(pixels.size() * sizeof(Pixel));
  std::memcpy(m.data().data(), pixels.data(), m.data().size());
  return m;
}

TEST(DepthImages, InMetresAndMillimetresGiveTheSamePoints) {
  const Pinhole camera = read_camera_info(info(4, 2)).value();
  SensorCloud metres, millimetres;
  const float inf = std::numeric_limits<float>::infinity();
  ASSERT_TRUE(read_depth(image_of<float>({2, kNan, 0, 1, inf, -1, 4, 0.5F}, "32FC1"), camera,
                         kMostPoints, metres));
  ASSERT_TRUE(read_depth(image_of<std::uint16_t>({2000, 0, 0, 1000, 0, 0, 4000, 500}, "16UC1"),
                         camera, kMostPoints, millimetres));
  const std::vector<Vec3> expected{
      Vec3(2 * -1.5 / 50, 2 * -0.5 / 40, 2), Vec3(1.5 / 50, -0.5 / 40, 1),
      Vec3(4 * 0.5 / 50, 4 * 0.5 / 40, 4), Vec3(0.5 * 1.5 / 50, 0.5 * 0.5 / 40, 0.5)};
  ASSERT_EQ(metres.points.size(), expected.size());
  ASSERT_EQ(millimetres.points.size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) {
    EXPECT_LT((metres.points[i] - expected[i]).norm(), 1e-12);
    EXPECT_LT((millimetres.points[i] - expected[i]).norm(), 1e-12);
  }
  EXPECT_EQ(metres.stamp_ns, 100'000'000'000);
}

void expect_refused(const Image& m, const std::string& words) {
  SensorCloud cloud;
  const Status status = read_depth(m, read_camera_info(info(4, 2)).value(), 100, cloud);
  ASSERT_FALSE(status) << words;
  EXPECT_EQ(status.code(), ErrorCode::invalid_input);
  EXPECT_THAT(status.error().message, HasSubstr(words));
}

TEST(DepthImages, ThatDoNotFitAreRefusedWithTheirFault) {
  const Image good = image_of<float>(std::vector<float>(8, 1.0F), "32FC1");
  for (const char* encoding : {"rgb8", "", "16UC3", "64FC1"}) {
    Image m = good;
    m.encoding(encoding);
    expect_refused(m, std::string("encoding is '") + encoding + "'");
  }
  Image m = good;
  m.is_bigendian(1);
  expect_refused(m, "big-endian");
  m = good;
  m.height(3);
  expect_refused(m, "4 x 3 pixels, but its CameraInfo is for 4 x 2");
  m = good;
  m.step(15);
  expect_refused(m, "rows of 15 bytes");
  m = good;
  m.data().pop_back();
  expect_refused(m, "brings 31 bytes");
  SensorCloud cloud;
  EXPECT_EQ(read_depth(good, read_camera_info(info(4, 2)).value(), 7, cloud).code(),
            ErrorCode::invalid_input);
}

TEST(DepthImages, NeedACalibratedCameraWithoutDistortion) {
  EXPECT_EQ(read_camera_info(CameraInfo()).code(), ErrorCode::invalid_input);
  EXPECT_EQ(read_camera_info(info(0, 2)).code(), ErrorCode::invalid_input);
  CameraInfo m = info(4, 2);
  m.k()[0] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(read_camera_info(m).code(), ErrorCode::invalid_input);
  m = info(4, 2);
  m.d({0.0, 0.0, 0.0, 0.0, 0.0});
  EXPECT_TRUE(read_camera_info(m));
  m.d()[1] = 0.1;
  const auto distorted = read_camera_info(m);
  ASSERT_FALSE(distorted);
  EXPECT_THAT(distorted.error().message, HasSubstr("rectified"));
}

TEST(OctoMaps, ComeBackFromTheirMessageAsTheyWere) {
  const GridGeometry geometry{Vec3(-0.4, 0.2, 0.0), 0.2, {7, 5, 3}};
  RawVoxels map{geometry, BitGrid(geometry.size, true), BitGrid(geometry.size, false)};
  for (const Index3 v : {Index3{0, 0, 0}, Index3{6, 4, 2}, Index3{3, 2, 1}}) {
    map.known.set(v, true);
    map.occupied.set(v, v.x != 3);
  }
  octomap_msgs::msg::Octomap m;
  ASSERT_TRUE(fill_octomap(map.geometry, map.occupied, map.known, m));
  const auto read = read_octomap(m);
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_LT((read->geometry.origin_map - geometry.origin_map).norm(), 1e-9);
  EXPECT_EQ(read->known, map.known);
  EXPECT_EQ(read->occupied, map.occupied);

  m.id("ColorOcTree");
  EXPECT_EQ(read_octomap(m).code(), ErrorCode::invalid_input);
  m.id("OcTree");
  m.binary(false);
  EXPECT_EQ(read_octomap(m).code(), ErrorCode::invalid_input);
  m.binary(true);
  m.data().pop_back();
  EXPECT_FALSE(read_octomap(m));
}

geometry_msgs::msg::TransformStamped transform(double x_m, double w) {
  geometry_msgs::msg::TransformStamped m;
  m.header().frame_id("base_link");
  m.header().stamp().sec(3);
  m.child_frame_id("lidar");
  m.transform().translation().x(x_m);
  m.transform().rotation().w(w);
  return m;
}

TEST(Transforms, FixedOnesHoldAtAllTimesAndOthersAtTheirStamp) {
  FrameTree frames(5.0, 0.5);
  ASSERT_TRUE(add_transform(transform(0.2, 1.0), true, frames));
  EXPECT_EQ(frames.chain("lidar", "base_link")->at(77)->position, Vec3(0.2, 0, 0));
  FrameTree moving(5.0, 0.5);
  ASSERT_TRUE(add_transform(transform(0.3, 1.0), false, moving));
  EXPECT_EQ(moving.chain("lidar", "base_link")->at(3'000'000'000)->position, Vec3(0.3, 0, 0));
  EXPECT_FALSE(moving.chain("lidar", "base_link")->at(77));
}

TEST(Transforms, ThatAreNoPoseAreRefusedByName) {
  FrameTree frames(5.0, 0.5);
  for (const auto& m : {transform(kNan, 1.0), transform(0.2, 0.0), transform(0.2, kNan)}) {
    const auto status = add_transform(m, true, frames);
    EXPECT_EQ(status.code(), ErrorCode::invalid_input);
    EXPECT_THAT(status.error().message, HasSubstr("'lidar'"));
  }
  EXPECT_FALSE(frames.chain("lidar", "base_link"));
}

}  // namespace
}  // namespace goshawk::map_server
