#pragma once

#include "goshawk/core/vehicle.hpp"
#include "goshawk/px4_wire/messages.hpp"

namespace goshawk::px4_stand_in {

/// Where the stand-in believes to be: its local NED frame against the true world (`map`, ENU). By
/// rotation matrices, so that it shares no formula with the bridge that it tests.
class LocalFrame {
 public:
  LocalFrame(const Vec3& origin_map, double yaw_rad);

  Vec3 point(const Vec3& map) const { return ned_map_ * (map - origin_map_); }
  Vec3 vector(const Vec3& map) const { return ned_map_ * map; }
  Vec3 point_to_map(const Vec3& ned) const { return ned_map_.transpose() * ned + origin_map_; }
  Vec3 vector_to_map(const Vec3& ned) const { return ned_map_.transpose() * ned; }
  /// FRD to NED, and back.
  Eigen::Matrix3d attitude(const Quaternion& q_map_base) const;
  Quaternion attitude_to_map(const Eigen::Matrix3d& ned_frd) const;
  /// Body rates: FLU and FRD.
  static Vec3 body(const Vec3& v) { return {v.x(), -v.y(), -v.z()}; }

  /// From now on it believes to be elsewhere: position new minus old, heading new minus old, NED.
  /// A reset of the heading leaves the position as it is.
  void reset(const Vec3& delta_ned, double delta_heading, const Vec3& vehicle_map);

 private:
  void turn(double yaw_rad);

  Vec3 origin_map_;
  double yaw_rad_ = 0.0;  // of local east in the map
  Eigen::Matrix3d ned_map_;
};

}  // namespace goshawk::px4_stand_in
