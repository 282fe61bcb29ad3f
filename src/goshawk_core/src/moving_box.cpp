#include "goshawk/core/moving_box.hpp"

#include <fmt/format.h>

#include <cmath>

namespace goshawk {
namespace {

constexpr double kFarthest_m = 1e6;
constexpr double kLargest_m = 1e3;

std::string fault_of(const MovingBox& b) {
  if (!is_finite(b.position_map) || b.position_map.cwiseAbs().maxCoeff() > kFarthest_m) {
    return "its place is not within 1e6 m";
  }
  if (!is_finite(b.velocity_map) || !is_finite(b.angular_velocity_map)) {
    return "its velocity is not finite";
  }
  if (!is_finite(b.half_m) || !(b.half_m.minCoeff() > 0.0) || b.half_m.maxCoeff() > kLargest_m) {
    return "its half extents are not within 0 to 1000 m";
  }
  if (!(std::abs(b.q_map_box.norm() - 1.0) < 1e-6)) return "its quaternion has no length of 1";
  const auto is_error = [](double e) { return e >= 0.0 && std::isfinite(e); };
  if (!is_error(b.position_error_m) || !is_error(b.velocity_error_m_s)) {
    return "its errors are not finite and 0 or more";
  }
  return "";
}

}  // namespace

Status MovingBox::check() const {
  const std::string fault = fault_of(*this);
  if (fault.empty()) return success();
  return fail(ErrorCode::invalid_input, fmt::format("moving box {}: {}", id, fault));
}

}  // namespace goshawk
