#include "goshawk/map_server_messages/transform.hpp"

#include <fmt/format.h>

#include "goshawk/conversions/geometry.hpp"
#include "goshawk/conversions/vehicle.hpp"

namespace goshawk::map_server {

Status add_transform(const geometry_msgs::msg::TransformStamped& m, bool fixed, FrameTree& frames) {
  const auto q = conversions::from_msg(m.transform().rotation());
  const Vec3 p = conversions::from_msg(m.transform().translation());
  if (!q || !is_finite(p)) {
    return fail(ErrorCode::invalid_input,
                fmt::format("the transform of '{}' is not finite, or its quaternion is zero",
                            m.child_frame_id()));
  }
  const std::string& parent = m.header().frame_id();
  if (!fixed) {
    return frames.add(parent, m.child_frame_id(), conversions::to_ns(m.header().stamp()), {p, *q});
  }
  frames.set_static(parent, m.child_frame_id(), {p, *q});
  return success();
}

}  // namespace goshawk::map_server
