#include "messages.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>

#include "goshawk/conversions/vehicle.hpp"

namespace goshawk::sensors {
namespace {

using sensor_msgs::msg::PointCloud2;
using sensor_msgs::msg::PointField;

enum Datatype : std::uint8_t { kUint8 = 2, kUint16 = 4, kUint32 = 6, kFloat32 = 7, kFloat64 = 8 };

struct FieldLayout {
  const char* name;
  std::uint32_t offset;
  Datatype type;
};

struct Layout {
  std::vector<FieldLayout> fields;
  std::uint32_t point_step;
};

Layout layout_of(Fields fields) {
  std::vector<FieldLayout> list{{"x", 0, kFloat32}, {"y", 4, kFloat32}, {"z", 8, kFloat32}};
  const auto with = [&](std::initializer_list<FieldLayout> more, std::uint32_t step) {
    list.insert(list.end(), more);
    return Layout{std::move(list), step};
  };
  switch (fields) {
    case Fields::ouster:
      return with({{"intensity", 16, kFloat32},
                   {"t", 20, kUint32},
                   {"reflectivity", 24, kUint16},
                   {"ring", 26, kUint16},
                   {"ambient", 28, kUint16},
                   {"range", 32, kUint32}},
                  48);
    case Fields::livox:
      return with({{"intensity", 12, kFloat32},
                   {"tag", 16, kUint8},
                   {"line", 17, kUint8},
                   {"timestamp", 18, kFloat64}},
                  26);
    case Fields::xyz:
      return with({}, 12);
    case Fields::velodyne:
    case Fields::automatic:
      break;
  }
  return with({{"intensity", 12, kFloat32}, {"ring", 16, kUint16}, {"time", 18, kFloat32}}, 22);
}

template <typename T>
void put(std::uint8_t* point, std::uint32_t offset, T value) {
  std::memcpy(point + offset, &value, sizeof value);
}

// Millimetres, as Ouster counts them.
std::uint32_t millimetres(double length_m) {
  return std::uint32_t(std::lround(1e3 * length_m));
}

// Nothing for a missing return, and for one whose pose is not known.
std::optional<Eigen::Vector3f> place_of(const Return& r, const Scan& scan, const CloudForm& form,
                                        const PoseTrack& track) {
  if (!r.valid) return std::nullopt;
  if (form.optical) return Eigen::Vector3f(-r.point.y(), -r.point.z(), r.point.x());
  if (form.frame == CloudFrame::sensor) return r.point;
  const Vec3 p_base = form.mount.position_map + form.mount.q_map_base * r.point.cast<double>();
  if (form.frame == CloudFrame::base_link) return p_base.cast<float>();
  const auto pose = track.at(scan.start_ns + r.offset_ns);
  if (!pose) return std::nullopt;
  return (pose->position_map + pose->q_map_base * p_base).cast<float>();
}

Eigen::Vector3f missing_place(Missing missing) {
  const bool nan = missing == Missing::nan;
  return Eigen::Vector3f::Constant(nan ? std::numeric_limits<float>::quiet_NaN() : 0.0F);
}

void put_extras(const Return& r, const Scan& scan, const CloudForm& form, std::uint8_t* point) {
  switch (form.fields) {
    case Fields::ouster:
      put(point, 16, r.intensity);
      put(point, 20, r.offset_ns);
      put(point, 24, std::uint16_t(std::lround(r.intensity)));
      put(point, 26, std::uint16_t(form.channels - 1 - r.ring));  // counted from above
      put(point, 32, r.valid ? millimetres(double(r.point.norm())) : 0U);
      return;
    case Fields::livox:
      put(point, 12, r.intensity);
      put(point, 17, std::uint8_t(r.ring));
      put(point, 18, double(scan.start_ns + r.offset_ns));
      return;
    case Fields::velodyne:
      put(point, 12, r.intensity);
      put(point, 16, r.ring);
      put(point, 18, float(1e-9 * r.offset_ns));
      return;
    case Fields::xyz:
    case Fields::automatic:
      return;
  }
}

// Where a return stands in an organised cloud: a row for each channel, the highest first.
std::size_t organised_place(std::size_t i, const Return& r, const CloudForm& form,
                            std::size_t columns) {
  const std::size_t row = std::size_t(form.channels - 1 - r.ring);
  return row * columns + i / std::size_t(form.channels);
}

void set_layout(const Layout& layout, PointCloud2& m) {
  if (m.fields().size() == layout.fields.size()) return;
  m.fields().clear();
  for (const auto& f : layout.fields) {
    PointField field;
    field.name(f.name);
    field.offset(f.offset);
    field.datatype(f.type);
    field.count(1);
    m.fields().push_back(field);
  }
}

}  // namespace

std::string optical_frame(const Config& config) {
  return config.frame + "_optical";
}

Status check_missing(const Config& config) {
  if (config.missing != Missing::zero || config.cloud_frame == CloudFrame::sensor) return success();
  const std::string_view frame = to_word(config.cloud_frame);
  return fail(ErrorCode::invalid_parameter,
              fmt::format("missing is zero and cloud_frame is {}: a missing return would be an "
                          "obstacle at the origin of {}. Set missing to leave_out or nan, or "
                          "cloud_frame to sensor",
                          frame, frame));
}

CloudForm CloudForm::of(const Config& c) {
  const Pattern pattern = c.sensor.pattern.pattern;
  const bool camera = pattern == Pattern::depth_camera;
  CloudForm form;
  form.channels = pattern == Pattern::spinning ? c.sensor.pattern.channels : 1;
  form.fields = c.fields;
  if (c.fields == Fields::automatic) {
    const bool spins = pattern == Pattern::spinning;
    const Fields spinning = c.sensor.pattern.channels_together ? Fields::ouster : Fields::velodyne;
    form.fields = camera ? Fields::xyz : spins ? spinning : Fields::livox;
  }
  form.missing = c.missing;
  if (c.missing == Missing::automatic) {
    const bool all = form.fields == Fields::ouster || form.fields == Fields::livox;
    const bool at_sensor = c.cloud_frame == CloudFrame::sensor;
    form.missing = all && at_sensor ? Missing::zero : Missing::leave_out;
  }
  form.frame = c.cloud_frame;
  form.optical = camera && c.cloud_frame == CloudFrame::sensor;
  form.mount = mount_of(c.sensor.mount);
  switch (c.cloud_frame) {
    case CloudFrame::sensor:
      form.frame_id = camera ? optical_frame(c) : c.frame;
      break;
    case CloudFrame::base_link:
      form.frame_id = conversions::kBodyFrame;
      break;
    case CloudFrame::map:
      form.frame_id = conversions::kMapFrame;
      break;
  }
  return form;
}

void fill_msg(const Scan& scan, const CloudForm& form, const PoseTrack& track, PointCloud2& m) {
  const Layout layout = layout_of(form.fields);
  set_layout(layout, m);
  m.header(conversions::make_header(scan.start_ns, form.frame_id));
  const std::size_t step = layout.point_step;
  const std::size_t columns = scan.returns.size() / std::size_t(form.channels);
  const bool organised = form.fields == Fields::ouster && form.missing != Missing::leave_out;
  m.data().assign(scan.returns.size() * step, 0);
  std::size_t count = 0;
  bool all_valid = true;
  for (std::size_t i = 0; i < scan.returns.size(); ++i) {
    const Return& r = scan.returns[i];
    const auto place = place_of(r, scan, form, track);
    if (!place && form.missing == Missing::leave_out) continue;
    all_valid = all_valid && (place || form.missing == Missing::zero);
    const std::size_t n = organised ? organised_place(i, r, form, columns) : count;
    std::uint8_t* point = m.data().data() + n * step;
    const Eigen::Vector3f p = place.value_or(missing_place(form.missing));
    for (int axis = 0; axis < 3; ++axis) put(point, std::uint32_t(4 * axis), p[axis]);
    put_extras(r, scan, form, point);
    ++count;
  }
  m.data().resize(count * step);
  m.height(organised ? std::uint32_t(form.channels) : 1);
  m.width(std::uint32_t(count) / m.height());
  m.point_step(layout.point_step);
  m.row_step(m.width() * m.point_step());
  m.is_bigendian(false);
  m.is_dense(all_valid);
}

void fill_msg(const Scan& scan, const Config& config, sensor_msgs::msg::Image& m) {
  const auto& p = config.sensor.pattern;
  const bool metres = config.image_encoding == ImageEncoding::float_m;
  const std::uint32_t bytes = metres ? 4 : 2;
  m.header(conversions::make_header(scan.start_ns, optical_frame(config)));
  m.height(std::uint32_t(p.height));
  m.width(std::uint32_t(p.width));
  m.encoding(std::string(to_word(config.image_encoding)));
  m.is_bigendian(0);
  m.step(m.width() * bytes);
  m.data().resize(scan.returns.size() * bytes);
  for (std::size_t i = 0; i < scan.returns.size(); ++i) {
    const Return& r = scan.returns[i];
    std::uint8_t* pixel = m.data().data() + i * bytes;
    if (metres) {
      put(pixel, 0, r.valid ? r.point.x() : std::numeric_limits<float>::quiet_NaN());
    } else {
      put(pixel, 0, std::uint16_t(std::min(millimetres(double(r.point.x())), 65535U)));
    }
  }
}

sensor_msgs::msg::CameraInfo camera_info(const PatternParameters& pattern) {
  const Pinhole c = Pinhole::of(pattern);
  sensor_msgs::msg::CameraInfo m;
  m.height(std::uint32_t(pattern.height));
  m.width(std::uint32_t(pattern.width));
  m.distortion_model("plumb_bob");
  m.d(std::vector<double>(5, 0.0));
  m.k({c.focal, 0.0, c.center_x, 0.0, c.focal, c.center_y, 0.0, 0.0, 1.0});
  m.r({1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0});
  m.p({c.focal, 0.0, c.center_x, 0.0, 0.0, c.focal, c.center_y, 0.0, 0.0, 0.0, 1.0, 0.0});
  return m;
}

tf2_msgs::msg::TFMessage static_transforms(const Config& config, std::int64_t stamp_ns) {
  const auto transform = [&](std::string_view parent, const std::string& child, const Pose& pose) {
    geometry_msgs::msg::TransformStamped t;
    t.header(conversions::make_header(stamp_ns, parent));
    t.child_frame_id(child);
    t.transform().translation(conversions::to_vector(pose.position_map));
    t.transform().rotation(conversions::to_msg(pose.q_map_base));
    return t;
  };
  tf2_msgs::msg::TFMessage m;
  m.transforms().push_back(
      transform(conversions::kBodyFrame, config.frame, mount_of(config.sensor.mount)));
  if (config.sensor.pattern.pattern == Pattern::depth_camera) {
    const Quaternion optical(0.5, -0.5, 0.5, -0.5);  // z forward instead of x, x right, y down
    m.transforms().push_back(
        transform(config.frame, optical_frame(config), {Vec3::Zero(), optical}));
  }
  return m;
}

}  // namespace goshawk::sensors
