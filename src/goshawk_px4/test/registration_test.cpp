#include "goshawk/px4/registration.hpp"

#include <gtest/gtest.h>

#include "goshawk/px4_wire/codec.hpp"
#include "recorder.hpp"

namespace goshawk::px4 {
namespace {

constexpr std::int64_t kBegin_ns = 10'000'000'000, kTick_ns = 1'000'000'000;

class Registrations : public testing::Test {
 protected:
  Registrations() { config.mode = ModeKind::external; }

  RegisterExtComponentReply reply() {
    registration.step(kBegin_ns, link);
    RegisterExtComponentReply m;
    m.request_id = link.registrations.back().request_id;
    m.name = link.registrations.back().name;
    m.success = true;
    m.arming_check_id = 2;
    m.mode_id = 24;
    return m;
  }

  Recorder link;
  Config config;
  Registration registration{config, 100};
};

TEST_F(Registrations, PX4GivesTheModeAndItsChecksAreAnswered) {
  ASSERT_TRUE(registration.hear(reply(), kBegin_ns));
  EXPECT_EQ(text_of(link.registrations[0].name), "Goshawk");
  ASSERT_EQ(registration.mode(), 24);
  ArmingCheckRequest request;
  request.request_id = 9;
  registration.hear(request, false, kBegin_ns, link);
  ASSERT_EQ(link.replies.size(), 1u);
  EXPECT_EQ(link.replies[0].request_id, 9);
  EXPECT_EQ(link.replies[0].registration_id, 2);
  EXPECT_FALSE(link.replies[0].can_arm_and_run);
  EXPECT_TRUE(link.replies[0].mode_req_local_position);
}

TEST_F(Registrations, AnswersToOthersDoNotCount) {
  auto m = reply();
  m.request_id += 1;
  EXPECT_TRUE(registration.hear(m, kBegin_ns));
  EXPECT_FALSE(registration.mode());
}

TEST_F(Registrations, ARefusalIsSaid) {
  auto m = reply();
  m.success = false;
  EXPECT_EQ(registration.hear(m, kBegin_ns).code(), ErrorCode::not_permitted);
  m.success = true;
  m.mode_id = -1;
  EXPECT_EQ(registration.hear(m, kBegin_ns).code(), ErrorCode::not_permitted);
  EXPECT_FALSE(registration.mode());
}

TEST_F(Registrations, APx4ThatForgotTheModeIsAskedAgain) {
  ASSERT_TRUE(registration.hear(reply(), kBegin_ns));
  registration.step(kBegin_ns + 5 * kTick_ns, link);  // no arming check for 4 s
  EXPECT_FALSE(registration.mode());
  EXPECT_EQ(link.registrations.size(), 2u);
}

TEST_F(Registrations, AModeThatTheMaskLeavesOutIsForgotten) {
  ASSERT_TRUE(registration.hear(reply(), kBegin_ns));
  ArmingCheckRequest request;
  request.valid_registrations_mask = 0b1011;
  registration.hear(request, true, kBegin_ns, link);
  EXPECT_FALSE(registration.mode());
  EXPECT_TRUE(link.replies.empty());
}

TEST_F(Registrations, SetpointsAreConfiguredAsEachReleaseWants) {
  ASSERT_TRUE(registration.hear(reply(), kBegin_ns));
  registration.configure(kBegin_ns, link);
  ASSERT_EQ(link.modes.size(), 1u);
  EXPECT_EQ(link.modes[0].source_id, 24);
  EXPECT_TRUE(link.modes[0].position);

  config.release = Release::v1_18;
  config.setpoint = SetpointLevel::attitude;
  Registration later(config, 7);
  later.step(kBegin_ns, link);
  RegisterExtComponentReply m;
  m.request_id = link.registrations.back().request_id;
  m.name = link.registrations.back().name;
  m.success = true;
  m.arming_check_id = 0;
  m.mode_id = 23;
  ASSERT_TRUE(later.hear(m, kBegin_ns));
  EXPECT_EQ(link.registrations.back().px4_ros2_api_version, 2);
  later.configure(kBegin_ns, link);
  ASSERT_EQ(link.configs.size(), 1u);
  EXPECT_EQ(link.configs[0].type, SetpointConfig::kAttitude);
  EXPECT_TRUE(link.configs[0].should_apply);
  SetpointConfigReply confirmed;
  confirmed.type = SetpointConfig::kAttitude;
  confirmed.source_id = 23;
  later.hear(confirmed);
  later.configure(kBegin_ns + kTick_ns, link);
  EXPECT_EQ(link.configs.size(), 1u);
  later.activated();
  later.configure(kBegin_ns + 2 * kTick_ns, link);
  EXPECT_EQ(link.configs.size(), 2u);
}

}  // namespace
}  // namespace goshawk::px4
