#include "goshawk/core/limits.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace goshawk {
namespace {

TEST(Limits, CheckNamesEveryFault) {
  EXPECT_TRUE(Limits{}.check().ok());
  for (const double bad : {0.0, -1.0, double(NAN), double(INFINITY)}) {
    const auto status = Limits{.v_max_m_s = bad, .a_max_m_s2 = bad}.check();
    EXPECT_EQ(status.code(), ErrorCode::invalid_limits);
    EXPECT_NE(status.error().message.find("v_max_m_s is"), std::string::npos);
    EXPECT_NE(status.error().message.find("a_max_m_s2 is"), std::string::npos);
    EXPECT_EQ(Limits{.a_max_m_s2 = bad}.check().error().message.find("v_max"), std::string::npos);
  }
}

TEST(Limits, OfJerkAndOfTheVerticalMayBeNone) {
  EXPECT_TRUE((Limits{.j_max_m_s3 = 3.0, .v_max_vertical_m_s = 1.0}.check().ok()));
  for (const double bad : {-1.0, double(NAN), double(INFINITY)}) {
    EXPECT_EQ((Limits{.j_max_m_s3 = bad}.check().code()), ErrorCode::invalid_limits);
    EXPECT_EQ((Limits{.v_max_vertical_m_s = bad}.check().code()), ErrorCode::invalid_limits);
    EXPECT_EQ((Limits{.a_max_vertical_m_s2 = bad}.check().code()), ErrorCode::invalid_limits);
  }
}

TEST(Limits, NormSaysWhatTheyBound) {
  const Vec3 v(3, -4, 12);
  Limits limits{.v_max_m_s = 2.0, .a_max_m_s2 = 4.0};
  EXPECT_DOUBLE_EQ(limits.speed_usage(v), 6.5);
  EXPECT_DOUBLE_EQ(limits.acceleration_usage(v), 3.25);
  limits.norm = LimitNorm::per_axis;
  EXPECT_DOUBLE_EQ(limits.speed_usage(v), 6.0);
  limits.norm = LimitNorm::horizontal_vertical;
  EXPECT_DOUBLE_EQ(limits.speed_usage(v), 6.0) << "without a vertical limit the same holds";
  limits.v_max_vertical_m_s = 8.0;
  EXPECT_DOUBLE_EQ(limits.speed_usage(v), 2.5) << "the horizontal length of 5 decides";
  limits.a_max_vertical_m_s2 = 1.0;
  EXPECT_DOUBLE_EQ(limits.acceleration_usage(v), 12.0);
}

TEST(Limits, UsageOfNaNIsNaN) {
  for (const LimitNorm norm :
       {LimitNorm::euclidean, LimitNorm::per_axis, LimitNorm::horizontal_vertical}) {
    for (int axis = 0; axis < 3; ++axis) {
      Vec3 v(1, 1, 1);
      v[axis] = NAN;
      EXPECT_TRUE(std::isnan(Limits{.norm = norm}.speed_usage(v))) << axis;
      EXPECT_TRUE(std::isnan(Limits{.norm = norm}.acceleration_usage(v))) << axis;
    }
  }
}

TEST(StartAllowance, IsNothingWithinTheLimits) {
  FlatState start;
  start.velocity = Vec3(2, 0, 0);
  start.acceleration = Vec3(0, 2, 0);
  const auto allowance = StartAllowance::of(start, Limits{});
  EXPECT_EQ(allowance.speed, 1.0);
  EXPECT_EQ(allowance.acceleration, 1.0);
  EXPECT_EQ(allowance.until_s, 0.0);
}

TEST(StartAllowance, GivesASpeedAboveTheLimitTwiceTheTimeThatBrakingTakes) {
  FlatState start;
  start.velocity = Vec3(0, 3, 0);
  const auto allowance = StartAllowance::of(start, Limits{.v_max_m_s = 2.0, .a_max_m_s2 = 4.0});
  EXPECT_DOUBLE_EQ(allowance.speed, 1.5 + 0.1 * 4.0 / 2.0);
  EXPECT_DOUBLE_EQ(allowance.acceleration, 1.0);
  EXPECT_DOUBLE_EQ(allowance.until_s, 2.0 * (1.0 / 4.0) + 0.5);
}

}  // namespace
}  // namespace goshawk
