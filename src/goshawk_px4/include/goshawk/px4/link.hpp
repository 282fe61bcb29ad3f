#pragma once

#include "goshawk/core/error.hpp"
#include "goshawk/px4_wire/commands.hpp"
#include "goshawk/px4_wire/mode_messages.hpp"

namespace goshawk::px4 {

/// What the bridge sends to PX4, and what it tells people.
class Link {
 public:
  virtual ~Link() = default;
  virtual void send(const VehicleCommand& m) = 0;
  virtual void send(const OffboardControlMode& m) = 0;
  virtual void send(const TrajectorySetpoint& m) = 0;
  virtual void send(const VehicleAttitudeSetpoint& m) = 0;
  virtual void send(const MessageFormatRequest& m) = 0;
  virtual void send(const RegisterExtComponentRequest& m) = 0;
  virtual void send(const ArmingCheckReply& m) = 0;
  virtual void send(const VehicleControlMode& m) = 0;  // up to 1.17
  virtual void send(const SetpointConfig& m) = 0;      // from 1.18 on
  /// @param fault ok: news
  virtual void tell(const Error& fault) = 0;
};

}  // namespace goshawk::px4
