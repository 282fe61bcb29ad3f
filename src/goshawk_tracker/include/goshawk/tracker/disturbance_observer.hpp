#pragma once

#include "goshawk/core/vector.hpp"

namespace goshawk::tracker {

/// Learns the acceleration that the model does not explain (wind, a wrong mass, unknown drag) from
/// the velocity alone: the integral action of the controller. Unlike an integral of the tracking
/// error it does not wind up when thrust or tilt is limited, for it knows what was really asked.
/// First-order: an unknown constant is learnt with the time constant 1 / bandwidth. (Chen et al.
/// 2000, nonlinear disturbance observer, for a point mass.)
class DisturbanceObserver {
 public:
  /// @param bandwidth_rad_s >= 0; 0 switches it off @param max_m_s2 >= 0, bound on the answer
  DisturbanceObserver(double bandwidth_rad_s, double max_m_s2);

  /// One velocity that lies moves what was learnt by a few tenths of max_m_s2 at the most.
  /// @param velocity_map [m/s] measured
  /// @param modelled_acceleration_map [m/s^2] what the model expects, over the past dt_s
  /// @param dt_s [s] since the last update; without use when above 0.1: what was learnt is kept
  void update(const Vec3& velocity_map, const Vec3& modelled_acceleration_map, double dt_s);

  /// [m/s^2] the acceleration that the model does not explain
  const Vec3& disturbance_map() const { return disturbance_map_; }

  void reset();
  /// The next velocity does not follow on the last one: nothing is learnt from their difference.
  void interrupt() { running_ = false; }

 private:
  double bandwidth_rad_s_;
  double max_m_s2_;
  bool running_ = false;
  Vec3 last_velocity_map_ = Vec3::Zero();
  Vec3 disturbance_map_ = Vec3::Zero();
};

}  // namespace goshawk::tracker
