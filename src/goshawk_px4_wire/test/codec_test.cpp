#include "goshawk/px4_wire/codec.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "goshawk/px4_wire/commands.hpp"
#include "goshawk/px4_wire/mode_messages.hpp"

namespace goshawk::px4 {
namespace {

constexpr std::array kEveryRelease{Release::v1_15, Release::v1_16, Release::v1_17, Release::v1_18};

template <typename Message>
Message through(const Message& message, Release release) {
  const auto definition = definition_of(Message::kType, release);
  Bytes bytes;
  encode(definition.layout, message, bytes);
  auto back = decode<Message>(definition.layout, bytes);
  if (!back) throw std::logic_error(back.error().message);
  return *back;
}

/// Every field of the struct is in every release that has the message: else encode() throws.
template <typename Message>
void expect_in_all_releases() {
  for (const Release release : kEveryRelease) {
    if (!find_definition(Message::kType, release)) continue;
    EXPECT_NO_THROW(through(Message{}, release));
  }
}

TEST(Codec, FieldsAreInEveryRelease) {
  expect_in_all_releases<VehicleOdometry>();
  expect_in_all_releases<VehicleLocalPosition>();
  expect_in_all_releases<VehicleStatus>();
  expect_in_all_releases<VehicleLandDetected>();
  expect_in_all_releases<BatteryStatus>();
  expect_in_all_releases<FailsafeFlags>();
  expect_in_all_releases<ManualControlSetpoint>();
  expect_in_all_releases<VehicleCommandAck>();
  expect_in_all_releases<VehicleCommand>();
  expect_in_all_releases<OffboardControlMode>();
  expect_in_all_releases<TrajectorySetpoint>();
  expect_in_all_releases<VehicleAttitudeSetpoint>();
  expect_in_all_releases<MessageFormatRequest>();
  expect_in_all_releases<MessageFormatResponse>();
  expect_in_all_releases<RegisterExtComponentRequest>();
  expect_in_all_releases<RegisterExtComponentReply>();
  expect_in_all_releases<UnregisterExtComponent>();
  expect_in_all_releases<ArmingCheckRequest>();
  expect_in_all_releases<ArmingCheckReply>();
  expect_in_all_releases<VehicleControlMode>();
  expect_in_all_releases<SetpointConfig>();
  expect_in_all_releases<SetpointConfigReply>();
}

TEST(Codec, WhatIsWrittenIsRead) {
  for (const Release release : kEveryRelease) {
    VehicleStatus status;
    status.arming_state = VehicleStatus::kArmed;
    status.nav_state = nav_state::kOffboard;
    status.system_id = 7;
    status.failsafe = true;
    status.pre_flight_checks_pass = true;
    EXPECT_EQ(through(status, release), status);

    TrajectorySetpoint setpoint;
    setpoint.position = {1.0f, 2.0f, -3.0f};
    setpoint.yawspeed = 0.25f;
    const auto back = through(setpoint, release);
    EXPECT_EQ(back.position, setpoint.position);
    EXPECT_TRUE(std::isnan(back.velocity[1]));
    EXPECT_EQ(back.yawspeed, 0.25f);

    RegisterExtComponentRequest request;
    request.name = characters_of<25>("Goshawk");
    EXPECT_EQ(text_of(through(request, release).name), "Goshawk");
  }
}

// Written by hand from the format: VehicleCommandAck.
TEST(Codec, BytesAreThoseOfTheFormat) {
  Bytes bytes{0, 1, 0, 0};
  const std::vector<unsigned char> body{1,    0,    0,    0,    0, 0, 0, 0,  // timestamp
                                        0x90, 1,    0,    0,                 // command 400
                                        1,    0,    0,    0,     // result, result_param1, padding
                                        0xff, 0xff, 0xff, 0xff,  // result_param2
                                        3,    0,    0xe9, 3,     // target_system, target_component
                                        1};                      // from_external
  bytes.insert(bytes.end(), body.begin(), body.end());
  const auto ack =
      decode<VehicleCommandAck>(definition_of("VehicleCommandAck", Release::v1_17).layout, bytes);
  ASSERT_TRUE(ack) << ack.error().message;
  EXPECT_EQ(ack->command, VehicleCommand::kArm);
  EXPECT_EQ(ack->result, 1);
  EXPECT_EQ(ack->target_component, 1001);
}

TEST(Codec, AFieldThatOnlyLaterReleasesHaveKeepsItsDefault) {
  ArmingCheckRequest request;
  request.valid_registrations_mask = 5;
  EXPECT_EQ(through(request, Release::v1_15).valid_registrations_mask, 0xffffffffu);
  EXPECT_EQ(through(request, Release::v1_17).valid_registrations_mask, 5u);
}

TEST(Codec, WhatIsNotOfThisLayoutIsRefused) {
  const auto definition = definition_of("VehicleLandDetected", Release::v1_17);
  Bytes good;
  encode(definition.layout, VehicleLandDetected{true}, good);
  Bytes short_one(good.begin(), good.end() - 1);
  EXPECT_EQ(decode<VehicleLandDetected>(definition.layout, short_one).code(),
            ErrorCode::invalid_input);
  EXPECT_EQ(decode<VehicleLandDetected>(definition.layout, {}).code(), ErrorCode::invalid_input);
  Bytes big_endian = good;
  big_endian[1] = 0;
  EXPECT_EQ(decode<VehicleLandDetected>(definition.layout, big_endian).code(),
            ErrorCode::invalid_input);
  Bytes no_bool = good;
  no_bool[kHeaderSize + definition.layout.find("landed")->offset] = 7;
  EXPECT_EQ(decode<VehicleLandDetected>(definition.layout, no_bool).code(),
            ErrorCode::invalid_input);
}

}  // namespace
}  // namespace goshawk::px4
