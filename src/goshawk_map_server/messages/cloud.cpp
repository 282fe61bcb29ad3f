#include "goshawk/map_server_messages/cloud.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "goshawk/conversions/geometry.hpp"

namespace goshawk::map_server {
namespace {

using sensor_msgs::msg::PointCloud2;
using sensor_msgs::msg::PointField;

constexpr std::uint8_t kUint32 = 6, kFloat32 = 7, kFloat64 = 8;
constexpr double kLongestScan_s = 1.0;
constexpr double kFarthestFloat_m = 1e5;  // float32 tells 8 mm apart there

std::size_t bytes_of(std::uint8_t type) {
  constexpr std::array<std::size_t, 9> bytes{0, 1, 1, 2, 2, 4, 4, 4, 8};
  return type < bytes.size() ? bytes[type] : 0;
}

const PointField* find(const PointCloud2& m, std::string_view name) {
  for (const auto& field : m.fields()) {
    if (field.name() == name) return &field;
  }
  return nullptr;
}

bool fits(const PointField& field, const PointCloud2& m) {
  return std::size_t(field.offset()) + bytes_of(field.datatype()) <= m.point_step();
}

template <typename T>
T value_at(const std::uint8_t* point, const PointField& field) {
  T value;
  std::memcpy(&value, point + field.offset(), sizeof value);
  return value;
}

double number_at(const std::uint8_t* point, const PointField& field) {
  return field.datatype() == kFloat64 ? value_at<double>(point, field)
                                      : double(value_at<float>(point, field));
}

// The fields x, y and z.
Result<std::array<const PointField*, 3>> places_of(const PointCloud2& m) {
  std::array<const PointField*, 3> places{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::string name(1, "xyz"[axis]);
    const PointField* field = find(m, name);
    if (field != nullptr && bytes_of(field->datatype()) != 0 && field->datatype() < kFloat32) {
      return fail(ErrorCode::invalid_input,
                  fmt::format("the cloud's field '{}' holds whole numbers, whose unit no message "
                              "tells: send metres as float32 or float64",
                              name));
    }
    if (field == nullptr || bytes_of(field->datatype()) == 0 || !fits(*field, m)) {
      return fail(ErrorCode::invalid_input,
                  fmt::format("the cloud {}: send x, y and z in metres as float32 or float64",
                              field == nullptr ? fmt::format("has no field '{}'", name)
                                               : fmt::format("has a field '{}' of an unknown type, "
                                                             "or beyond its point_step of {} bytes",
                                                             name, m.point_step())));
    }
    places[axis] = field;
  }
  return places;
}

Status check_size(const PointCloud2& m, std::size_t max_points) {
  const std::size_t row_points = std::size_t(m.width()) * m.point_step();
  if (m.point_step() == 0 || row_points > m.row_step() ||
      std::size_t(m.row_step()) * m.height() > m.data().size()) {
    return fail(ErrorCode::invalid_input,
                fmt::format("the cloud claims {} x {} points of {} bytes, but brings {} bytes",
                            m.height(), m.width(), m.point_step(), m.data().size()));
  }
  const std::size_t points = std::size_t(m.width()) * m.height();
  if (points > max_points) {
    return fail(ErrorCode::invalid_input,
                fmt::format("the cloud has {} points, more than max_points ({}): thin it out, or "
                            "raise the limit",
                            points, max_points));
  }
  return success();
}

/// When a point was measured, from whatever field the driver fills.
class PointTimes {
 public:
  explicit PointTimes(const PointCloud2& m) {
    for (const char* name : {"t", "offset_time", "time", "timestamp"}) {
      const PointField* field = find(m, name);
      if (field == nullptr || !fits(*field, m)) continue;
      const bool whole = field->datatype() == kUint32;
      const bool real = field->datatype() == kFloat32 || field->datatype() == kFloat64;
      const bool counts = name[0] == 'o' || name[1] == '\0';  // nanoseconds
      if ((counts && whole) || (!counts && real)) {
        field_ = field;
        return;
      }
    }
  }

  bool there() const { return field_ != nullptr; }

  /// [s] after the stamp; far off if the field cannot be understood
  double offset_s(const std::uint8_t* point, double stamp_s) const {
    if (field_->datatype() == kUint32) return 1e-9 * value_at<std::uint32_t>(point, *field_);
    const double value = number_at(point, *field_);
    if (field_->name() != "timestamp") return value;
    const double in_seconds = value - stamp_s, in_nanoseconds = 1e-9 * value - stamp_s;
    return std::abs(in_seconds) < std::abs(in_nanoseconds) ? in_seconds : in_nanoseconds;
  }

  const std::string& name() const { return field_->name(); }

 private:
  const PointField* field_ = nullptr;
};

Status read_points(const PointCloud2& m, const std::array<const PointField*, 3>& places,
                   SensorCloud& cloud) {
  const PointTimes times(m);
  const double stamp_s = 1e-9 * double(cloud.stamp_ns);
  for (std::size_t row = 0; row < m.height(); ++row) {
    for (std::size_t column = 0; column < m.width(); ++column) {
      const std::uint8_t* point = m.data().data() + row * m.row_step() + column * m.point_step();
      const Vec3 p(number_at(point, *places[0]), number_at(point, *places[1]),
                   number_at(point, *places[2]));
      if (!p.allFinite()) continue;  // a missing return; its time may be nothing as well
      cloud.points.push_back(p);
      if (!times.there()) continue;
      const double offset_s = times.offset_s(point, stamp_s);
      if (!(std::abs(offset_s) <= kLongestScan_s)) {
        return fail(ErrorCode::invalid_input,
                    fmt::format("the cloud's field '{}' puts a point {:.3g} s away from the "
                                "stamp: it must be the time after the stamp, or of its clock",
                                times.name(), offset_s));
      }
      cloud.offsets_ns.push_back(std::llround(1e9 * offset_s));
    }
  }
  return success();
}

// In coordinates of a map projection float32 is too coarse: 0.5 m at 5,000,000 m.
Status check_near(const PointCloud2& m, const SensorCloud& cloud) {
  const PointField* x = find(m, "x");
  const bool coarse = x->datatype() == kFloat32 && m.header().frame_id() == conversions::kMapFrame;
  if (!coarse || cloud.points.empty()) return success();
  const auto size = [](const Vec3& p) { return p.cwiseAbs().maxCoeff(); };
  const Vec3 nearest = std::ranges::min(cloud.points, {}, size);
  if (size(nearest) <= kFarthestFloat_m) return success();
  const Vec3 offset = 1000.0 * (nearest / 1000.0).array().round().matrix();
  return fail(ErrorCode::invalid_input,
              fmt::format("the cloud's points are {:.0f} m and more from the origin of frame map, "
                          "where float32 is too coarse: subtract an offset as {:.0f}, {:.0f}, "
                          "{:.0f} m from clouds, odometry and goals",
                          size(nearest), offset.x(), offset.y(), offset.z()));
}

}  // namespace

Status read_cloud(const PointCloud2& m, std::size_t max_points, SensorCloud& cloud) {
  cloud.points.clear();
  cloud.offsets_ns.clear();
  cloud.stamp_ns = conversions::to_ns(m.header().stamp());
  if (m.is_bigendian()) {
    return fail(ErrorCode::invalid_input, "the cloud is big-endian: send it little-endian");
  }
  if (m.width() == 0 || m.height() == 0) return success();  // nothing was seen
  const auto places = places_of(m);
  if (!places) return places.error();
  if (auto status = check_size(m, max_points); !status) return status;
  if (auto status = read_points(m, *places, cloud); !status) return status;
  return check_near(m, cloud);
}

}  // namespace goshawk::map_server
