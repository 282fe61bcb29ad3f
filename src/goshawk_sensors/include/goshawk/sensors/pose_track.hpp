#pragma once

#include <cstdint>
#include <deque>
#include <optional>

#include "goshawk/core/result.hpp"
#include "goshawk/core/vehicle.hpp"

namespace goshawk::sensors {

struct Pose {
  Vec3 position_map = Vec3::Zero();                // [m]
  Quaternion q_map_base = Quaternion::Identity();  // base_link to map
};

/// Where the vehicle was: the poses of the last seconds by their stamps. Between two of them the
/// vehicle moves straight and turns about one axis at one rate (slerp).
class PoseTrack {
 public:
  /// @param max_gap_s longer pauses between two poses are not bridged
  explicit PoseTrack(double max_gap_s = 0.5, double keep_s = 2.0);

  /// A stamp that is not above the newest one, as after a reset, starts the track anew.
  /// @return invalid_input for a pose that is not finite: it is not taken
  Status add(std::int64_t stamp_ns, const Pose& pose);

  /// @return nothing outside of the track, and in a gap
  std::optional<Pose> at(std::int64_t time_ns) const;

  bool empty() const { return entries_.empty(); }
  std::int64_t first_ns() const { return entries_.front().stamp_ns; }
  std::int64_t last_ns() const { return entries_.back().stamp_ns; }

 private:
  struct Entry {
    std::int64_t stamp_ns;
    Pose pose;
    // Towards the next entry:
    Vec3 axis_base = Vec3::UnitZ();
    double angle_rad = 0.0;
  };

  std::int64_t max_gap_ns_, keep_ns_;
  std::deque<Entry> entries_;
  mutable std::size_t last_found_ = 0;
};

}  // namespace goshawk::sensors
