#pragma once

#include <memory>

#include "goshawk/core/trajectory.hpp"
#include "goshawk/simulator/quadrotor.hpp"

namespace goshawk::closed_loop {

/// How the vehicle follows what the tracker wants.
enum class Tracking {
  physical,  // motors, drag and an attitude loop between the command and the motion
  ideal,     // it is where the tracker wants it, as the simulators of many planners assume
};

/// What the loop flies. Time in whole milliseconds.
class Vehicle {
 public:
  virtual ~Vehicle() = default;

  virtual std::int64_t time_ns() const = 0;
  virtual const RigidBodyState& state() const = 0;  // the truth
  virtual simulator::Measurement measure() = 0;     // the estimate

  /// @param command of the tracker @param reference where it wants the vehicle now
  /// @return invalid_input for a command that no vehicle takes
  virtual Status command(const AttitudeSetpoint& command, const FlatState& reference) = 0;
  /// One millisecond.
  virtual void advance() = 0;
};

/// Hovering at a place. @return invalid_parameter for the configuration, invalid_input for a place
/// that is not finite
Result<std::unique_ptr<Vehicle>> make_vehicle(Tracking tracking, const simulator::Config& config,
                                              const Vec3& home_map);

}  // namespace goshawk::closed_loop
