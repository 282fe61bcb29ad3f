#include "messages.hpp"

#include <algorithm>

#include "goshawk/conversions/geometry.hpp"
#include "goshawk/conversions/vehicle.hpp"

namespace goshawk::obstacle_tracker {
namespace {

void fill_one(const TrackedObstacle& o, goshawk_msgs::msg::PredictedObstacle& m) {
  m.id(o.box.id);
  m.kind(o.box.kind);
  m.half_extents(conversions::to_vector(o.box.half_m));
  m.orientation(conversions::to_msg(o.box.q_map_box));
  m.track().resize(1);
  goshawk_msgs::msg::TrackPiece& piece = m.track().front();
  piece.duration(o.horizon_s);
  const Vec3 end = o.box.position_map + o.horizon_s * o.box.velocity_map;
  piece.control_points().resize(2);
  piece.control_points()[0] = conversions::to_point(o.box.position_map);
  piece.control_points()[1] = conversions::to_point(end);
  m.error(o.bound_m);
  m.error_rate(o.bound_rate_m_s);
  m.valid_until(o.horizon_s);
  m.top_speed(o.top_speed_m_s);
}

}  // namespace

void fill_msg(std::span<const TrackedObstacle> obstacles,
              goshawk_msgs::msg::PredictedObstacles& m) {
  m.obstacles().resize(obstacles.size());
  for (std::size_t i = 0; i < obstacles.size(); ++i) fill_one(obstacles[i], m.obstacles()[i]);
}

std::vector<TrackedObstacle> bounded(const std::vector<MovingBox>& boxes, const Config& config) {
  std::vector<TrackedObstacle> found;
  for (const MovingBox& box : boxes) {
    TrackedObstacle o;
    o.box = box;
    // The box of a prediction keeps its orientation: one that turns needs the ball around it.
    if (box.angular_velocity_map.norm() > 0.0) {
      o.box.half_m = Vec3::Constant(box.half_m.norm());
      o.box.q_map_box = Quaternion::Identity();
    }
    const bool stands = box.velocity_map.norm() == 0.0 && box.velocity_error_m_s == 0.0;
    o.bound_m = 2.0 * box.position_error_m;
    o.bound_rate_m_s = 2.0 * box.velocity_error_m_s + (stands ? 0.0 : config.agility_m_s);
    o.horizon_s = config.horizon_s;
    o.top_speed_m_s = stands ? 0.0 : std::max(config.top_speed_m_s, box.velocity_map.norm());
    found.push_back(o);
  }
  return found;
}

}  // namespace goshawk::obstacle_tracker
