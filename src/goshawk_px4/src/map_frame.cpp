#include "goshawk/px4/map_frame.hpp"

#include <cmath>
#include <numbers>

namespace goshawk::px4 {

MapFrame::MapFrame(const Vec3& origin_map, double yaw_rad) : origin_(origin_map) {
  set_yaw(yaw_rad);
}

double MapFrame::yaw_to_local(double yaw_map_rad) const {
  return std::remainder(yaw_map_rad - yaw_rad_, 2.0 * std::numbers::pi);
}

void MapFrame::reset(const Vec3& delta_local, double delta_yaw_rad, const Vec3& position_local) {
  const Vec3 stays_map = point_to_map(position_local - delta_local);
  set_yaw(yaw_rad_ - delta_yaw_rad);
  origin_ = stays_map - turn_ * position_local;
}

void MapFrame::set_yaw(double yaw_rad) {
  yaw_rad_ = std::remainder(yaw_rad, 2.0 * std::numbers::pi);
  turn_ = Eigen::AngleAxisd(yaw_rad_, Vec3::UnitZ());
}

}  // namespace goshawk::px4
