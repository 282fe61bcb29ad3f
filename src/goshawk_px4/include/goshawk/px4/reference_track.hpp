#pragma once

#include <cstdint>
#include <optional>

#include "goshawk/core/fallback_stop.hpp"
#include "goshawk/core/result.hpp"
#include "goshawk/core/vehicle.hpp"
#include "goshawk/px4/config.hpp"

namespace goshawk::px4 {

/// What is sent to PX4 at each moment: the tracker's reference, as its fallback stop tells it in
/// advance. If the tracker falls silent, the same goes on to rest, in space that was proved free,
/// and holds. Frame `map`.
class ReferenceTrack {
 public:
  explicit ReferenceTrack(const Config& config);

  /// Holds where the vehicle comes to rest if it brakes now.
  void hold(const RigidBodyState& vehicle);
  /// Climbs straight to this height above the point that is held.
  void climb(double height_m, std::int64_t now_ns);

  /// The tracker's: taken if it begins near what is flown, or near the vehicle.
  /// @return not_at_start if it does not; trajectory_infeasible if it is faster than v_max_m_s.
  /// What is flown then goes on to rest
  Status offer(FallbackStop stop, const RigidBodyState& vehicle, std::int64_t now_ns);
  void turn_to(double yaw_rad) { yaw_rad_ = yaw_rad; }

  FlatState at(std::int64_t now_ns) const;
  double yaw_rad() const { return yaw_rad_; }
  bool at_rest(std::int64_t now_ns) const;
  /// [s] since the tracker's last one was taken; nothing: none was since hold()
  std::optional<double> age_s(std::int64_t now_ns) const;

 private:
  const Config& config_;
  Vec3 held_map_ = Vec3::Zero();
  double yaw_rad_ = 0.0;
  double climb_m_ = 0.0;
  std::int64_t begin_ns_ = 0;
  std::optional<FallbackStop> stop_;
};

}  // namespace goshawk::px4
