#include "goshawk/map_server_messages/depth_image.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "goshawk/conversions/geometry.hpp"

namespace goshawk::map_server {
namespace {

using sensor_msgs::msg::CameraInfo;
using sensor_msgs::msg::Image;

Error wrong(std::string sentence) {
  return fail(ErrorCode::invalid_input, std::move(sentence));
}

/// [byte] of a pixel; 0: an encoding that is no depth.
std::size_t pixel_bytes(const std::string& encoding) {
  if (encoding == "32FC1") return 4;
  return encoding == "16UC1" || encoding == "mono16" ? 2 : 0;
}

Status check(const Image& m, const Pinhole& camera, std::size_t max_points) {
  const std::size_t bytes = pixel_bytes(m.encoding());
  if (bytes == 0) {
    return wrong(
        fmt::format("the image's encoding is '{}': send depth as 32FC1 in metres or as "
                    "16UC1 in millimetres",
                    m.encoding()));
  }
  if (m.is_bigendian() != 0) return wrong("the image is big-endian: send it little-endian");
  if (m.width() != camera.width || m.height() != camera.height) {
    return wrong(
        fmt::format("the image has {} x {} pixels, but its CameraInfo is for {} x {}: both "
                    "must be of one size",
                    m.width(), m.height(), camera.width, camera.height));
  }
  if (m.width() * bytes > m.step() || std::size_t(m.step()) * m.height() > m.data().size()) {
    return wrong(
        fmt::format("the image claims {} rows of {} bytes for {} pixels, but brings {} "
                    "bytes",
                    m.height(), m.step(), m.width(), m.data().size()));
  }
  const std::size_t pixels = std::size_t(m.width()) * m.height();
  if (pixels > max_points) {
    return wrong(
        fmt::format("the image has {} pixels, more than max_points ({}): reduce it, or "
                    "raise the limit",
                    pixels, max_points));
  }
  return success();
}

template <typename Pixel>
double depth_at(const std::uint8_t* pixel, double unit_m) {
  Pixel value;
  std::memcpy(&value, pixel, sizeof value);
  return unit_m * double(value);
}

template <typename Pixel>
void read_pixels(const Image& m, const Pinhole& c, double unit_m, std::vector<Vec3>& points) {
  for (std::uint32_t v = 0; v < m.height(); ++v) {
    const std::uint8_t* row = m.data().data() + std::size_t(v) * m.step();
    for (std::uint32_t u = 0; u < m.width(); ++u) {
      const double z = depth_at<Pixel>(row + u * sizeof(Pixel), unit_m);
      if (!(std::isfinite(z) && z > 0.0)) continue;
      points.push_back({z * (u - c.center_x) / c.focal_x, z * (v - c.center_y) / c.focal_y, z});
    }
  }
}

}  // namespace

Result<Pinhole> read_camera_info(const CameraInfo& m) {
  const auto& k = m.k();
  const Pinhole camera{m.width(), m.height(), k[0], k[4], k[2], k[5]};
  const bool finite =
      std::isfinite(k[2]) && std::isfinite(k[5]) && std::isfinite(k[0]) && std::isfinite(k[4]);
  if (!finite || !(camera.focal_x > 0.0 && camera.focal_y > 0.0) || camera.width == 0 ||
      camera.height == 0) {
    return wrong(
        fmt::format("the CameraInfo of '{}' has {} x {} pixels and focal lengths of {:g} "
                    "and {:g} pixels: all must be above zero; calibrate the camera",
                    m.header().frame_id(), m.width(), m.height(), k[0], k[4]));
  }
  if (std::ranges::any_of(m.d(), [](double d) { return d != 0.0; })) {
    return wrong(
        fmt::format("the CameraInfo of '{}' has a distortion: send the rectified image "
                    "with its own CameraInfo",
                    m.header().frame_id()));
  }
  return camera;
}

Status read_depth(const Image& m, const Pinhole& camera, std::size_t max_points,
                  SensorCloud& cloud) {
  cloud.points.clear();
  cloud.offsets_ns.clear();
  cloud.stamp_ns = conversions::to_ns(m.header().stamp());
  if (auto status = check(m, camera, max_points); !status) return status;
  if (m.encoding() == "32FC1") {
    read_pixels<float>(m, camera, 1.0, cloud.points);
  } else {
    read_pixels<std::uint16_t>(m, camera, 1e-3, cloud.points);
  }
  return success();
}

}  // namespace goshawk::map_server
