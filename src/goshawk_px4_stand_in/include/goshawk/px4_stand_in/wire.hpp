#pragma once

#include "goshawk/px4_wire/commands.hpp"
#include "goshawk/px4_wire/mode_messages.hpp"

namespace goshawk::px4_stand_in {

/// What the stand-in sends, as PX4 does.
class Wire {
 public:
  virtual ~Wire() = default;
  virtual void send(const px4::VehicleStatus& m) = 0;
  virtual void send(const px4::VehicleLandDetected& m) = 0;
  virtual void send(const px4::BatteryStatus& m) = 0;
  virtual void send(const px4::FailsafeFlags& m) = 0;
  virtual void send(const px4::ManualControlSetpoint& m) = 0;
  virtual void send(const px4::VehicleLocalPosition& m) = 0;
  virtual void send(const px4::VehicleOdometry& m) = 0;
  virtual void send(const px4::VehicleCommandAck& m) = 0;
  virtual void send(const px4::MessageFormatResponse& m) = 0;
  virtual void send(const px4::RegisterExtComponentReply& m) = 0;
  virtual void send(const px4::ArmingCheckRequest& m) = 0;
  virtual void send(const px4::SetpointConfigReply& m) = 0;
};

}  // namespace goshawk::px4_stand_in
