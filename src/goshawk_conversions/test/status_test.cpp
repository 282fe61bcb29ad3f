#include "goshawk/conversions/status.hpp"

#include <gtest/gtest.h>

#include "goshawk_msgs.h"

namespace goshawk::conversions {
namespace {

TEST(StageRoles, ComeBackAsTheyWereSent) {
  for (int value = 0; value <= goshawk_msgs::msg::StageReport_Constants::STAGE_OBSTACLE_TRACKER;
       ++value) {
    EXPECT_EQ(to_msg(stage_role_of(std::uint8_t(value))), value);
  }
}

TEST(StageRoles, ThatAreNotKnownAreOther) {
  EXPECT_EQ(stage_role_of(std::uint8_t(200)), StageRole::other);
}

TEST(Words, AreThoseOfTheConstants) {
  using namespace goshawk_msgs::msg;
  EXPECT_EQ(navigator_state_word(NavigatorState_Constants::STATE_IDLE), "idle");
  EXPECT_EQ(navigator_state_word(NavigatorState_Constants::STATE_PLANNING), "planning");
  EXPECT_EQ(navigator_state_word(NavigatorState_Constants::STATE_FLYING), "flying");
  EXPECT_EQ(navigator_state_word(NavigatorState_Constants::STATE_ARRIVED), "arrived");
  EXPECT_EQ(navigator_state_word(NavigatorState_Constants::STATE_FAILED), "failed");
  EXPECT_EQ(navigator_state_word(NavigatorState_Constants::STATE_HELD), "held");
  EXPECT_EQ(navigator_state_word(77), "unknown");
  EXPECT_EQ(tracking_mode_word(TrackingState_Constants::MODE_IDLE), "idle");
  EXPECT_EQ(tracking_mode_word(TrackingState_Constants::MODE_HOLD), "hold");
  EXPECT_EQ(tracking_mode_word(TrackingState_Constants::MODE_FOLLOW), "follow");
  EXPECT_EQ(tracking_mode_word(TrackingState_Constants::MODE_BRAKE), "brake");
  EXPECT_EQ(tracking_mode_word(TrackingState_Constants::MODE_LAND), "land");
  EXPECT_EQ(tracking_mode_word(77), "unknown");
}

}  // namespace
}  // namespace goshawk::conversions
