#include "goshawk/px4_stand_in/local_frame.hpp"

#include <cmath>

namespace goshawk::px4_stand_in {
namespace {

const Eigen::Matrix3d& frd_flu() {
  static const Eigen::Matrix3d m = Vec3(1.0, -1.0, -1.0).asDiagonal();
  return m;
}

}  // namespace

LocalFrame::LocalFrame(const Vec3& origin_map, double yaw_rad) : origin_map_(origin_map) {
  turn(yaw_rad);
}

void LocalFrame::turn(double yaw_rad) {
  yaw_rad_ = yaw_rad;
  const double c = std::cos(yaw_rad), s = std::sin(yaw_rad);
  // Rows: north, east and down in the map, if local east lies at this heading.
  ned_map_ << -s, c, 0.0, c, s, 0.0, 0.0, 0.0, -1.0;
}

Eigen::Matrix3d LocalFrame::attitude(const Quaternion& q_map_base) const {
  return ned_map_ * q_map_base.toRotationMatrix() * frd_flu();
}

Quaternion LocalFrame::attitude_to_map(const Eigen::Matrix3d& ned_frd) const {
  const Eigen::Matrix3d map_base = ned_map_.transpose() * ned_frd * frd_flu();
  return Quaternion(map_base).normalized();
}

void LocalFrame::reset(const Vec3& delta_ned, double delta_heading, const Vec3& vehicle_map) {
  const Vec3 believed = point(vehicle_map) + delta_ned;
  turn(yaw_rad_ + delta_heading);
  origin_map_ = vehicle_map - ned_map_.transpose() * believed;
}

}  // namespace goshawk::px4_stand_in
