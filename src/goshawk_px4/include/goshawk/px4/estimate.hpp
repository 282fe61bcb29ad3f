#pragma once

#include <cstdint>
#include <optional>

#include "goshawk/core/result.hpp"
#include "goshawk/px4/config.hpp"
#include "goshawk/px4/map_frame.hpp"
#include "goshawk/px4_wire/messages.hpp"

namespace goshawk::px4 {

/// PX4's estimate as the state of the vehicle in `map`: its frames, its validity flags, its
/// uncertainty, and its resets as events that move the frame.
class Estimate {
 public:
  struct Reset {
    double position_m = 0.0;
    double heading_rad = 0.0;
  };

  explicit Estimate(const Config& config);

  /// @return the event, if this message tells of a reset of position or heading;
  /// tracking_lost: resets were missed, so that nobody knows where PX4's frame now lies
  Result<std::optional<Reset>> hear(const VehicleLocalPosition& local);

  /// @return the state; tracking_lost with the reason: not valid, too uncertain, in an unknown
  /// frame, or a reset of which the size is not known yet; invalid_input if not finite
  Result<RigidBodyState> hear(const VehicleOdometry& odometry);

  const MapFrame& frame() const { return frame_; }
  /// Resets of position and heading so far.
  std::uint32_t resets() const { return resets_; }

 private:
  Status check_flags() const;
  Status check_odometry(const VehicleOdometry& odometry) const;

  double max_deviation_m_;
  MapFrame frame_;
  std::optional<VehicleLocalPosition> local_;
  std::optional<std::uint8_t> counter_;  // of odometry
  std::uint64_t wait_for_us_ = 0;        // sample time from which local positions tell the reset
  std::uint32_t resets_ = 0;
};

}  // namespace goshawk::px4
