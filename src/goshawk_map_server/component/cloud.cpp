#include "cloud.hpp"

#include <array>
#include <cstring>

namespace goshawk::map_server {
namespace {

constexpr std::uint8_t kFloat32 = 7;

Result<std::array<std::size_t, 3>> offsets_of(const sensor_msgs::msg::PointCloud2& m) {
  std::array<std::size_t, 3> offsets{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::string name(1, "xyz"[axis]);
    const sensor_msgs::msg::PointField* found = nullptr;
    for (const auto& field : m.fields()) {
      if (field.name() == name) found = &field;
    }
    if (found == nullptr || found->datatype() != kFloat32 ||
        std::size_t(found->offset()) + sizeof(float) > m.point_step()) {
      return fail(ErrorCode::invalid_input,
                  "the cloud has no float32 field '" + name + "' inside its points");
    }
    offsets[axis] = found->offset();
  }
  return offsets;
}

}  // namespace

Result<std::vector<Vec3>> points_of(const sensor_msgs::msg::PointCloud2& m) {
  if (m.is_bigendian()) {
    return fail(ErrorCode::invalid_input, "the cloud is big-endian: send it little-endian");
  }
  if (m.width() == 0 || m.height() == 0) return std::vector<Vec3>{};  // the sensor saw nothing
  const auto offsets = offsets_of(m);
  if (!offsets) return offsets.error();
  const std::size_t row_points = std::size_t(m.width()) * m.point_step();
  if (row_points == 0 || row_points > m.row_step() ||
      std::size_t(m.row_step()) * m.height() > m.data().size()) {
    return fail(ErrorCode::invalid_input,
                "the cloud claims " + std::to_string(m.height()) + " x " +
                    std::to_string(m.width()) + " points of " + std::to_string(m.point_step()) +
                    " bytes, but brings " + std::to_string(m.data().size()) + " bytes");
  }
  std::vector<Vec3> points;
  points.reserve(std::size_t(m.width()) * m.height());
  for (std::size_t row = 0; row < m.height(); ++row) {
    for (std::size_t column = 0; column < m.width(); ++column) {
      const std::uint8_t* point = m.data().data() + row * m.row_step() + column * m.point_step();
      Vec3 p;
      for (int axis = 0; axis < 3; ++axis) {
        float value = 0.0F;
        std::memcpy(&value, point + (*offsets)[std::size_t(axis)], sizeof value);
        p[axis] = double(value);
      }
      points.push_back(p);
    }
  }
  return points;
}

}  // namespace goshawk::map_server
