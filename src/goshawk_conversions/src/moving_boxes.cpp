#include "goshawk/conversions/moving_boxes.hpp"

#include <fmt/format.h>

#include <unordered_set>

#include "goshawk/conversions/geometry.hpp"
#include "goshawk/conversions/vehicle.hpp"

namespace goshawk::conversions {
namespace {

Result<MovingBox> box_of(const goshawk_msgs::msg::MovingBox& m) {
  const auto q = from_msg(m.pose().orientation());
  if (!q) return fail(q.code(), fmt::format("moving box {}: {}", m.id(), q.error().message));
  MovingBox box{.id = m.id(),
                .kind = m.kind(),
                .position_map = from_msg(m.pose().position()),
                .q_map_box = *q,
                .half_m = from_msg(m.half_extents()),
                .velocity_map = from_msg(m.velocity().linear()),
                .angular_velocity_map = from_msg(m.velocity().angular()),
                .position_error_m = m.position_error(),
                .velocity_error_m_s = m.velocity_error()};
  if (auto status = box.check(); !status) return status.error();
  return box;
}

void fill_box(const MovingBox& box, goshawk_msgs::msg::MovingBox& m) {
  m.id(box.id);
  m.kind(box.kind);
  m.pose().position(to_point(box.position_map));
  m.pose().orientation(to_msg(box.q_map_box));
  m.half_extents(to_vector(box.half_m));
  m.velocity().linear(to_vector(box.velocity_map));
  m.velocity().angular(to_vector(box.angular_velocity_map));
  m.position_error(box.position_error_m);
  m.velocity_error(box.velocity_error_m_s);
}

}  // namespace

Result<std::vector<MovingBox>> from_msg(const goshawk_msgs::msg::MovingBoxes& m) {
  if (auto s = check_frame(m.header(), kMapFrame, "a list of moving boxes"); !s) return s.error();
  if (m.boxes().size() > kMostMovingBoxes) {
    return fail(ErrorCode::invalid_input, fmt::format("{} moving boxes are more than {}",
                                                      m.boxes().size(), kMostMovingBoxes));
  }
  std::vector<MovingBox> boxes;
  boxes.reserve(m.boxes().size());
  std::unordered_set<std::uint64_t> ids;
  for (const auto& b : m.boxes()) {
    auto box = box_of(b);
    if (!box) return box.error();
    if (!ids.insert(box->id).second) {
      return fail(ErrorCode::invalid_input, fmt::format("moving box {} is listed twice", box->id));
    }
    boxes.push_back(*std::move(box));
  }
  return boxes;
}

void fill_msg(const std::vector<MovingBox>& boxes, goshawk_msgs::msg::MovingBoxes& m) {
  m.boxes().resize(boxes.size());
  for (std::size_t i = 0; i < boxes.size(); ++i) fill_box(boxes[i], m.boxes()[i]);
}

}  // namespace goshawk::conversions
