#pragma once

#include "goshawk/core/vehicle.hpp"

namespace goshawk::px4 {

/// Where PX4's local frame (as ENU) lies in `map`. A reset of PX4's estimate moves this frame: the
/// vehicle stays where it is in the map, and so does all that is planned.
class MapFrame {
 public:
  MapFrame(const Vec3& origin_map, double yaw_rad);

  Vec3 point_to_map(const Vec3& local) const { return turn_ * local + origin_; }
  Vec3 vector_to_map(const Vec3& local) const { return turn_ * local; }
  Quaternion attitude_to_map(const Quaternion& local) const { return turn_ * local; }
  Vec3 point_to_local(const Vec3& map) const { return turn_.conjugate() * (map - origin_); }
  Vec3 vector_to_local(const Vec3& map) const { return turn_.conjugate() * map; }
  Quaternion attitude_to_local(const Quaternion& map) const { return turn_.conjugate() * map; }
  /// [rad] in [-pi, pi]
  double yaw_to_local(double yaw_map_rad) const;

  /// @param delta_local [m] new position minus old @param delta_yaw_rad new heading minus old, ENU
  /// @param position_local [m] of the vehicle, after the reset
  void reset(const Vec3& delta_local, double delta_yaw_rad, const Vec3& position_local);

 private:
  void set_yaw(double yaw_rad);

  Vec3 origin_;
  double yaw_rad_ = 0.0;
  Quaternion turn_ = Quaternion::Identity();
};

}  // namespace goshawk::px4
