#include "messages.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <map>

#include "support.hpp"

namespace goshawk::sensors {
namespace {

using sensor_msgs::msg::Image;
using sensor_msgs::msg::PointCloud2;

/// Three rays: two returns and a missing one between them.
Scan three_returns() {
  Scan scan;
  scan.start_ns = 1'700'000'000'123'456'000;
  scan.end_ns = scan.start_ns + 100'000'000;
  Return first{.point = {3.0F, 1.0F, -2.0F}, .intensity = 40.0F, .offset_ns = 1000, .ring = 0};
  Return last{.point = {0.0F, 0.0F, 5.0F}, .intensity = 90.0F, .offset_ns = 99'000'000, .ring = 2};
  first.valid = last.valid = true;
  scan.returns = {first, {.offset_ns = 2000, .ring = 1}, last};
  return scan;
}

Config config_of(Preset preset) {
  Config c;
  apply_preset(preset, c.sensor);
  c.frame = "lidar";
  return c;
}

const sensor_msgs::msg::PointField& field_of(const PointCloud2& m, const std::string& name) {
  for (const auto& field : m.fields()) {
    if (field.name() == name) return field;
  }
  throw std::runtime_error("no field " + name);
}

template <typename T>
T read(const PointCloud2& m, const std::string& name, std::size_t point) {
  T value;
  std::memcpy(&value, m.data().data() + point * m.point_step() + field_of(m, name).offset(),
              sizeof value);
  return value;
}

std::string fields_of(const PointCloud2& m) {
  static const std::map<int, std::string> kTypes{
      {2, "u8"}, {4, "u16"}, {6, "u32"}, {7, "f32"}, {8, "f64"}};
  std::string text;
  for (const auto& f : m.fields()) {
    text += f.name() + ":" + kTypes.at(f.datatype()) + "@" + std::to_string(f.offset()) + " ";
  }
  return text + "/" + std::to_string(m.point_step());
}

PointCloud2 cloud_of(const Scan& scan, const CloudForm& form,
                     const PoseTrack& track = PoseTrack()) {
  PointCloud2 m;
  fill_msg(scan, form, track, m);
  EXPECT_EQ(m.row_step(), m.width() * m.point_step());
  EXPECT_EQ(m.data().size(), std::size_t(m.row_step()) * m.height());
  EXPECT_FALSE(m.is_bigendian());
  return m;
}

TEST(CloudMessage, EachKindOfSensorHasTheFieldsOfItsDriver) {
  const Scan scan = three_returns();
  const auto fields = [&](Preset preset) {
    CloudForm form = CloudForm::of(config_of(preset));
    form.channels = 3;
    return fields_of(cloud_of(scan, form));
  };
  EXPECT_EQ(fields(Preset::vlp16),
            "x:f32@0 y:f32@4 z:f32@8 intensity:f32@12 ring:u16@16 time:f32@18 /22");
  EXPECT_EQ(fields(Preset::os1_128),
            "x:f32@0 y:f32@4 z:f32@8 intensity:f32@16 t:u32@20 reflectivity:u16@24 ring:u16@26 "
            "ambient:u16@28 range:u32@32 /48");
  EXPECT_EQ(fields(Preset::mid360),
            "x:f32@0 y:f32@4 z:f32@8 intensity:f32@12 tag:u8@16 line:u8@17 timestamp:f64@18 /26");
  EXPECT_EQ(fields(Preset::d435), "x:f32@0 y:f32@4 z:f32@8 /12");
}

TEST(CloudMessage, VelodynesLeavesMissingReturnsOutAndCountsTimeFromTheStamp) {
  const Scan scan = three_returns();
  const auto m = cloud_of(scan, CloudForm::of(config_of(Preset::vlp16)));
  EXPECT_EQ(m.header().frame_id(), "lidar");
  EXPECT_EQ(std::int64_t{m.header().stamp().sec()} * 1'000'000'000 + m.header().stamp().nanosec(),
            scan.start_ns);
  ASSERT_EQ(m.width(), 2U);
  EXPECT_EQ(m.height(), 1U);
  EXPECT_TRUE(m.is_dense());
  EXPECT_EQ(read<float>(m, "x", 0), 3.0F);
  EXPECT_EQ(read<float>(m, "y", 0), 1.0F);
  EXPECT_EQ(read<float>(m, "z", 1), 5.0F);
  EXPECT_EQ(read<float>(m, "intensity", 1), 90.0F);
  EXPECT_EQ(read<std::uint16_t>(m, "ring", 1), 2);
  EXPECT_NEAR(read<float>(m, "time", 1), 0.099, 1e-7);
}

TEST(CloudMessage, OustersIsOrganisedFromAboveWithZerosForMissingReturns) {
  Scan scan = three_returns();
  const Scan next = three_returns();
  scan.returns.insert(scan.returns.end(), next.returns.begin(), next.returns.end());
  CloudForm form = CloudForm::of(config_of(Preset::os0_128));
  form.channels = 3;
  const auto m = cloud_of(scan, form);
  EXPECT_EQ(m.height(), 3U);
  ASSERT_EQ(m.width(), 2U);
  for (std::size_t column = 0; column < 2; ++column) {
    EXPECT_EQ(read<float>(m, "z", column), 5.0F) << "the highest channel stands first";
    EXPECT_EQ(read<std::uint16_t>(m, "ring", column), 0);
    EXPECT_EQ(read<std::uint32_t>(m, "range", column), 5000U);
    EXPECT_EQ(read<std::uint32_t>(m, "t", column), 99'000'000U);
    EXPECT_EQ(read<float>(m, "x", 2 + column), 0.0F);
    EXPECT_EQ(read<std::uint32_t>(m, "range", 2 + column), 0U);
    EXPECT_EQ(read<float>(m, "x", 4 + column), 3.0F);
  }
}

TEST(CloudMessage, LivoxTellsAbsoluteTimeAndTheLine) {
  const Scan scan = three_returns();
  const auto m = cloud_of(scan, CloudForm::of(config_of(Preset::avia)));
  ASSERT_EQ(m.width(), 3U);
  EXPECT_EQ(read<float>(m, "x", 1), 0.0F) << "a missing return";
  EXPECT_EQ(read<double>(m, "timestamp", 2), double(scan.start_ns + 99'000'000));
  EXPECT_EQ(read<std::uint8_t>(m, "line", 2), 2);
}

TEST(CloudMessage, MissingReturnsMayBeNotANumber) {
  Config c = config_of(Preset::vlp16);
  c.missing = Missing::nan;
  const auto m = cloud_of(three_returns(), CloudForm::of(c));
  ASSERT_EQ(m.width(), 3U);
  EXPECT_FALSE(m.is_dense());
  EXPECT_TRUE(std::isnan(read<float>(m, "y", 1)));
}

// A zero means the sensor's own place only in the sensor's frame.
TEST(CloudMessage, OutsideTheSensorsFrameMissingReturnsAreNoPointsAtTheOrigin) {
  for (const Preset preset : {Preset::os0_128, Preset::mid360}) {
    for (const CloudFrame frame : {CloudFrame::base_link, CloudFrame::map}) {
      Config c = config_of(preset);
      c.cloud_frame = frame;
      const Scan scan = three_returns();
      PoseTrack track;
      for (int i = 0; i <= 10; ++i) {
        Pose pose;
        pose.position_map = Vec3(7.0, 7.0, 7.0);
        ASSERT_TRUE(track.add(scan.start_ns + 10'000'000LL * i, pose));
      }
      CloudForm form = CloudForm::of(c);
      form.channels = preset == Preset::os0_128 ? 3 : 1;
      const auto m = cloud_of(scan, form, track);
      EXPECT_EQ(m.width() * m.height(), 2U);
      for (std::size_t i = 0; i < m.width(); ++i) {
        EXPECT_FALSE(read<float>(m, "x", i) == 0.0F && read<float>(m, "y", i) == 0.0F &&
                     read<float>(m, "z", i) == 0.0F);
      }
    }
  }
}

TEST(CloudMessage, ZerosForMissingReturnsAreRefusedOutsideTheSensorsFrame) {
  Config c = config_of(Preset::mid360);
  c.missing = Missing::zero;
  EXPECT_TRUE(check_missing(c));
  for (const CloudFrame frame : {CloudFrame::base_link, CloudFrame::map}) {
    c.cloud_frame = frame;
    const Status status = check_missing(c);
    ASSERT_EQ(status.code(), ErrorCode::invalid_parameter);
    EXPECT_NE(status.error().message.find("Set missing to leave_out or nan"), std::string::npos);
  }
  c.missing = Missing::nan;
  EXPECT_TRUE(check_missing(c));
}

TEST(CloudMessage, InBaseLinkThePointsAreMovedByTheMount) {
  Config c = config_of(Preset::vlp16);
  c.cloud_frame = CloudFrame::base_link;
  c.sensor.mount.z_m = 0.5;
  c.sensor.mount.yaw_rad = 0.5 * kPi;
  const auto m = cloud_of(three_returns(), CloudForm::of(c));
  EXPECT_EQ(m.header().frame_id(), "base_link");
  EXPECT_NEAR(read<float>(m, "x", 0), -1.0, 1e-6);
  EXPECT_NEAR(read<float>(m, "y", 0), 3.0, 1e-6);
  EXPECT_NEAR(read<float>(m, "z", 0), -1.5, 1e-6);
}

TEST(CloudMessage, InMapEachPointIsMovedByThePoseAtItsRay) {
  Config c = config_of(Preset::vlp16);
  c.cloud_frame = CloudFrame::map;
  c.sensor.mount.z_m = 0.5;
  const Scan scan = three_returns();
  PoseTrack track;
  for (int i = 0; i <= 10; ++i) {  // at 10 m/s along y, turned by a right angle
    Pose pose;
    pose.position_map = Vec3(1.0, 0.1 * i, 0.0);
    pose.q_map_base = Eigen::AngleAxisd(0.5 * kPi, Vec3::UnitZ());
    ASSERT_TRUE(track.add(scan.start_ns + 10'000'000LL * i, pose));
  }
  const auto m = cloud_of(scan, CloudForm::of(c), track);
  EXPECT_EQ(m.header().frame_id(), "map");
  ASSERT_EQ(m.width(), 2U);
  EXPECT_NEAR(read<float>(m, "x", 0), 0.0, 1e-5);
  EXPECT_NEAR(read<float>(m, "y", 0), 3.00001, 1e-5);
  EXPECT_NEAR(read<float>(m, "z", 0), -1.5, 1e-5);
  EXPECT_NEAR(read<float>(m, "y", 1), 0.99, 1e-5) << "99 ms later";
  EXPECT_EQ(cloud_of(scan, CloudForm::of(c)).width(), 0U) << "no pose, no point";
}

TEST(CloudMessage, AMessageThatIsUsedAgainHoldsTheNewScanOnly) {
  Scan scan = three_returns();
  const CloudForm form = CloudForm::of(config_of(Preset::vlp16));
  PointCloud2 used;
  fill_msg(scan, form, PoseTrack(), used);
  scan.returns.pop_back();
  fill_msg(scan, form, PoseTrack(), used);
  EXPECT_EQ(used, cloud_of(scan, form));
}

/// An image of a wall at 2.5 m with one pixel that sees nothing.
Scan image_scan(const Config& c) {
  const FiringPattern pattern(c.sensor.pattern);
  Scan scan;
  scan.start_ns = 5'000'000'000;
  for (int i = 0; i < pattern.firings(); ++i) {
    const Vec3 d = pattern.at(0, i).direction_sensor;
    Return r;
    r.point = (2.5 / d.x() * d).cast<float>();
    r.valid = true;
    scan.returns.push_back(r);
  }
  scan.returns[5] = {};
  return scan;
}

Config small_camera() {
  Config c = config_of(Preset::d435);
  c.sensor.pattern.width = 8, c.sensor.pattern.height = 6;
  c.frame = "camera";
  return c;
}

TEST(ImageMessage, MetresAreFloatsAndAMissingReturnIsNotANumber) {
  const Config c = small_camera();
  Image m;
  fill_msg(image_scan(c), c, m);
  EXPECT_EQ(m.header().frame_id(), "camera_optical");
  EXPECT_EQ(m.encoding(), "32FC1");
  EXPECT_EQ(m.width(), 8U);
  EXPECT_EQ(m.height(), 6U);
  EXPECT_EQ(m.step(), 32U);
  ASSERT_EQ(m.data().size(), 8U * 6U * 4U);
  for (std::size_t i = 0; i < 48; ++i) {
    float depth = 0.0F;
    std::memcpy(&depth, m.data().data() + 4 * i, 4);
    EXPECT_EQ(std::isnan(depth), i == 5);
    EXPECT_TRUE(i == 5 || std::abs(depth - 2.5F) < 1e-6F) << depth;
  }
}

TEST(ImageMessage, MillimetresAreIntegersAndAMissingReturnIsZero) {
  Config c = small_camera();
  c.image_encoding = ImageEncoding::integer_mm;
  Image m;
  fill_msg(image_scan(c), c, m);
  EXPECT_EQ(m.encoding(), "16UC1");
  EXPECT_EQ(m.step(), 16U);
  for (std::size_t i = 0; i < 48; ++i) {
    std::uint16_t depth = 1;
    std::memcpy(&depth, m.data().data() + 2 * i, 2);
    EXPECT_EQ(depth, i == 5 ? 0 : 2500);
  }
}

TEST(ImageMessage, CameraInfoProjectsThePointsOfTheCloudOntoTheirPixels) {
  const Config c = small_camera();
  const auto info = camera_info(c.sensor.pattern);
  EXPECT_EQ(info.width(), 8U);
  EXPECT_EQ(info.height(), 6U);
  const Scan scan = image_scan(c);
  CloudForm form = CloudForm::of(c);
  EXPECT_EQ(form.frame_id, "camera_optical");
  form.missing = Missing::zero;
  const auto m = cloud_of(scan, form);
  for (std::size_t i = 0; i < 48; ++i) {
    if (i == 5) continue;
    const double x = read<float>(m, "x", i), y = read<float>(m, "y", i), z = read<float>(m, "z", i);
    EXPECT_NEAR(z, 2.5, 1e-6);
    EXPECT_NEAR(info.k()[0] * x / z + info.k()[2], double(i % 8), 1e-4);
    EXPECT_NEAR(info.k()[4] * y / z + info.k()[5], double(i / 8), 1e-4);
    EXPECT_EQ(info.p()[0], info.k()[0]);
  }
}

Quaternion rotation_of(const geometry_msgs::msg::TransformStamped& t) {
  const auto& q = t.transform().rotation();
  return {q.w(), q.x(), q.y(), q.z()};
}

TEST(StaticTransforms, LeadFromBaseLinkToTheSensorAndOnToTheOpticalFrame) {
  Config c = small_camera();
  c.sensor.mount = {.x_m = 0.1, .z_m = -0.02, .pitch_rad = 0.4};
  const auto tf = static_transforms(c, 7);
  ASSERT_EQ(tf.transforms().size(), 2U);
  const auto &mount = tf.transforms()[0], &optical = tf.transforms()[1];
  EXPECT_EQ(mount.header().frame_id(), "base_link");
  EXPECT_EQ(mount.child_frame_id(), "camera");
  EXPECT_EQ(mount.transform().translation().x(), 0.1);
  EXPECT_LT(rotation_of(mount).angularDistance(mount_of(c.sensor.mount).q_map_base), 1e-12);
  EXPECT_EQ(optical.header().frame_id(), "camera");
  EXPECT_EQ(optical.child_frame_id(), "camera_optical");
  const Quaternion q = rotation_of(optical);
  EXPECT_LT((q * Vec3::UnitZ() - Vec3::UnitX()).norm(), 1e-12) << "z is forward";
  EXPECT_LT((q * Vec3::UnitX() + Vec3::UnitY()).norm(), 1e-12) << "x is right";
  EXPECT_EQ(static_transforms(config_of(Preset::vlp16), 7).transforms().size(), 1U);
}

}  // namespace
}  // namespace goshawk::sensors
