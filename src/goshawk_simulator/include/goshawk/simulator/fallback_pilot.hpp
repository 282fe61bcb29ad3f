#pragma once

#include <cstdint>
#include <optional>

#include "goshawk/core/fallback_stop.hpp"
#include "goshawk/core/vehicle.hpp"
#include "goshawk/plant/vehicle_parameters.hpp"

namespace goshawk::simulator {

/// Flies the fallback stop that the tracker has given in advance, once setpoints have stopped
/// coming. It keeps the newest one that passes the vehicle, and follows it in space: where the
/// vehicle is decides how far along it is, so that neither clocks nor the delay of the link count.
/// Time is an argument, on one clock [ns].
class FallbackPilot {
 public:
  /// @param tolerance_m how far from the vehicle a stop may pass
  /// @pre parameters.check() ok; 0 < max_tilt_rad < pi/2
  FallbackPilot(const plant::VehicleParameters& parameters, double max_tilt_rad,
                double tolerance_m);

  void forget();

  /// Keeps it instead of the one before.
  /// @return invalid_input: as FallbackStop::check(); not_at_start: it does not pass the vehicle
  ///         as it moves now; the one before is kept
  Status offer(FallbackStop stop, const RigidBodyState& state, std::int64_t now_ns);

  /// Setpoints are lost. @return whether it flies: a stop was kept and passes the vehicle now
  bool engage(const RigidBodyState& state, std::int64_t now_ns);

  /// @pre engaged
  /// @param disturbance_map [m/s^2] what wind and drag do to the vehicle; compensated
  AttitudeSetpoint step(const RigidBodyState& state, std::int64_t now_ns,
                        const Vec3& disturbance_map) const;

  /// Where to hover, once the stop is flown to its end. @pre engaged
  std::optional<Vec3> ended(std::int64_t now_ns) const;

 private:
  /// [s] along the stop for the vehicle as it moves; nothing: it does not pass the vehicle
  std::optional<double> find(const FallbackStop& stop, const RigidBodyState& state,
                             double expected_s) const;
  double along_s(std::int64_t now_ns) const { return double(now_ns - begin_ns_) * 1e-9; }

  plant::VehicleParameters parameters_;
  double max_tilt_rad_;
  double tolerance_m_;
  std::optional<FallbackStop> stop_;
  std::int64_t begin_ns_ = 0;  // when the stop begins
  double yaw_rad_ = 0.0;
};

}  // namespace goshawk::simulator
