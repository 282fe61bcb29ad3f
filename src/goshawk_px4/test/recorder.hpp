#pragma once

#include <string>
#include <vector>

#include "goshawk/px4/link.hpp"

namespace goshawk::px4 {

/// Keeps what a bridge sends.
struct Recorder : Link {
  void send(const VehicleCommand& m) override { commands.push_back(m); }
  void send(const OffboardControlMode& m) override { alive.push_back(m); }
  void send(const TrajectorySetpoint& m) override { trajectories.push_back(m); }
  void send(const VehicleAttitudeSetpoint& m) override { attitudes.push_back(m); }
  void send(const MessageFormatRequest& m) override { formats.push_back(m); }
  void send(const RegisterExtComponentRequest& m) override { registrations.push_back(m); }
  void send(const ArmingCheckReply& m) override { replies.push_back(m); }
  void send(const VehicleControlMode& m) override { modes.push_back(m); }
  void send(const SetpointConfig& m) override { configs.push_back(m); }
  void tell(const Error& fault) override { told.push_back(fault); }

  bool told_of(const std::string& words) const {
    for (const auto& fault : told) {
      if (fault.message.find(words) != std::string::npos) return true;
    }
    return false;
  }

  std::vector<VehicleCommand> commands;
  std::vector<OffboardControlMode> alive;
  std::vector<TrajectorySetpoint> trajectories;
  std::vector<VehicleAttitudeSetpoint> attitudes;
  std::vector<MessageFormatRequest> formats;
  std::vector<RegisterExtComponentRequest> registrations;
  std::vector<ArmingCheckReply> replies;
  std::vector<VehicleControlMode> modes;
  std::vector<SetpointConfig> configs;
  std::vector<Error> told;
};

}  // namespace goshawk::px4
