#include "goshawk/px4_wire/definitions.hpp"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <string>

#include "definition_texts.hpp"

namespace goshawk::px4 {
namespace {

constexpr std::array kReleases{Release::v1_15, Release::v1_16, Release::v1_17, Release::v1_18};

struct Row {
  std::string_view type;
  Release since;
  int version;  // MESSAGE_VERSION: the suffix of the topic
  std::string_view text;
};
constexpr auto kRows = std::to_array<Row>(
    {{"VehicleOdometry", Release::v1_15, 0, kVehicleOdometry_1_15},
     {"VehicleLocalPosition", Release::v1_15, 0, kVehicleLocalPosition_1_15},
     {"VehicleLocalPosition", Release::v1_16, 0, kVehicleLocalPosition_1_16},
     {"VehicleLocalPosition", Release::v1_17, 1, kVehicleLocalPosition_1_16},
     {"VehicleStatus", Release::v1_15, 0, kVehicleStatus_1_15},
     {"VehicleStatus", Release::v1_16, 1, kVehicleStatus_1_16},
     {"VehicleStatus", Release::v1_18, 4, kVehicleStatus_1_18},
     {"VehicleLandDetected", Release::v1_15, 0, kVehicleLandDetected_1_15},
     {"BatteryStatus", Release::v1_15, 0, kBatteryStatus_1_15},
     {"BatteryStatus", Release::v1_16, 0, kBatteryStatus_1_16},
     {"BatteryStatus", Release::v1_17, 1, kBatteryStatus_1_17},
     {"FailsafeFlags", Release::v1_15, 0, kFailsafeFlags_1_15},
     {"FailsafeFlags", Release::v1_16, 0, kFailsafeFlags_1_16},
     {"FailsafeFlags", Release::v1_17, 0, kFailsafeFlags_1_17},
     {"FailsafeFlags", Release::v1_18, 0, kFailsafeFlags_1_18},
     {"ManualControlSetpoint", Release::v1_15, 0, kManualControlSetpoint_1_15},
     {"VehicleCommandAck", Release::v1_15, 0, kVehicleCommandAck_1_15},
     {"VehicleCommandAck", Release::v1_18, 1, kVehicleCommandAck_1_15},
     {"RegisterExtComponentReply", Release::v1_15, 0, kRegisterExtComponentReply_1_15},
     {"RegisterExtComponentReply", Release::v1_18, 1, kRegisterExtComponentReply_1_18},
     {"ArmingCheckRequest", Release::v1_15, 0, kArmingCheckRequest_1_15},
     {"ArmingCheckRequest", Release::v1_17, 1, kArmingCheckRequest_1_17},
     {"MessageFormatResponse", Release::v1_15, 0, kMessageFormatResponse_1_15},
     {"SetpointConfigReply", Release::v1_18, 0, kSetpointConfigReply_1_18},
     {"VehicleCommand", Release::v1_15, 0, kVehicleCommand_1_15},
     {"OffboardControlMode", Release::v1_15, 0, kOffboardControlMode_1_15},
     {"TrajectorySetpoint", Release::v1_15, 0, kTrajectorySetpoint_1_15},
     {"VehicleAttitudeSetpoint", Release::v1_15, 0, kVehicleAttitudeSetpoint_1_15},
     {"VehicleAttitudeSetpoint", Release::v1_16, 0, kVehicleAttitudeSetpoint_1_16},
     {"VehicleAttitudeSetpoint", Release::v1_17, 1, kVehicleAttitudeSetpoint_1_17},
     {"VehicleControlMode", Release::v1_15, 0, kVehicleControlMode_1_15},
     {"VehicleControlMode", Release::v1_18, 0, kVehicleControlMode_1_18},
     {"SetpointConfig", Release::v1_18, 0, kSetpointConfig_1_18},
     {"RegisterExtComponentRequest", Release::v1_15, 0, kRegisterExtComponentRequest_1_15},
     {"RegisterExtComponentRequest", Release::v1_18, 2, kRegisterExtComponentRequest_1_18},
     {"UnregisterExtComponent", Release::v1_15, 0, kUnregisterExtComponent_1_15},
     {"ArmingCheckReply", Release::v1_15, 0, kArmingCheckReply_1_15},
     {"ArmingCheckReply", Release::v1_17, 1, kArmingCheckReply_1_17},
     {"MessageFormatRequest", Release::v1_15, 0, kMessageFormatRequest_1_15}});

const Row* find_row(std::string_view type, Release release) {
  const Row* newest = nullptr;
  for (const Row& row : kRows) {
    if (row.type == type && row.since <= release) newest = &row;
  }
  return newest;
}

}  // namespace

std::optional<Definition> find_definition(std::string_view type, Release release) {
  const Row* row = find_row(type, release);
  if (row == nullptr) return {};
  return Definition{Layout(row->text), row->version};
}

Definition definition_of(std::string_view type, Release release) {
  auto found = find_definition(type, release);
  if (found) return *std::move(found);
  throw std::logic_error("PX4 " + std::string(to_word(release)) + " has no " + std::string(type));
}

std::string topic_of(std::string_view topic, const Definition& definition) {
  std::string name = "fmu/" + std::string(topic);
  if (definition.version > 0) name += "_v" + std::to_string(definition.version);
  return name;
}

std::string wire_type_of(std::string_view type) {
  return "px4_msgs::msg::dds_::" + std::string(type) + "_";
}

std::vector<Release> releases_with(std::string_view type, std::uint32_t hash) {
  std::vector<Release> found;
  std::ranges::copy_if(kReleases, std::back_inserter(found), [&](Release release) {
    const auto definition = find_definition(type, release);
    return definition && definition->layout.hash() == hash;
  });
  return found;
}

}  // namespace goshawk::px4
