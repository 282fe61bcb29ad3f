#include "goshawk/px4/config.hpp"

#include <gtest/gtest.h>

namespace goshawk::px4 {
namespace {

TEST(Config, TheDefaultsHold) {
  EXPECT_TRUE(check(Config{}));
}

TEST(Config, TheMarginMustCoverHowFarPx4FliesOn) {
  Config config;
  config.v_max_m_s = 1.0;
  config.offboard_loss_s = 0.4;
  config.brake_m_s2 = 2.0;
  config.a_max_m_s2 = 0.5;
  // 0.4 s and 0.1 s until PX4 notices: 0.5 m at 1 m/s, 0.0625 m by acceleration; then 1.25 m/s are
  // braked at 2 m/s^2.
  EXPECT_NEAR(flies_on_m(config, 1.0), 0.5 + 0.0625 + 0.390625, 1e-12);
  config.margin_m = 0.96;
  EXPECT_TRUE(check(config));
  config.margin_m = 0.95;
  const auto refused = check(config);
  EXPECT_EQ(refused.code(), ErrorCode::invalid_parameter);
  EXPECT_NE(refused.error().message.find("COM_OF_LOSS_T"), std::string::npos);
}

// Four missed checks: 1.25 s after the last reply, and 0.1 s. COM_OF_LOSS_T does not count there.
TEST(Config, AnExternalModeIsLostLater) {
  Config config;
  config.mode = ModeKind::external;
  EXPECT_NEAR(follows_on_s(config), 1.35, 1e-12);
  EXPECT_EQ(check(config).code(), ErrorCode::invalid_parameter);
  config.margin_m = 1.4;
  EXPECT_TRUE(check(config));
  config.release = Release::v1_15;
  EXPECT_NEAR(follows_on_s(config), 1.05, 1e-12);
}

TEST(Config, ValuesOutOfRangeAreNamed) {
  Config config;
  config.hover_thrust = 0.0;
  config.mass_kg = -1.0;
  const auto refused = check(config);
  ASSERT_EQ(refused.code(), ErrorCode::invalid_parameter);
  EXPECT_NE(refused.error().message.find("hover_thrust"), std::string::npos);
  EXPECT_NE(refused.error().message.find("mass_kg"), std::string::npos);
}

}  // namespace
}  // namespace goshawk::px4
