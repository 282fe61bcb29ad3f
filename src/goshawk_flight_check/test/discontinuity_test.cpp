#include "goshawk/flight_check/discontinuity.hpp"

#include <gmock/gmock.h>

#include "worlds.hpp"

namespace goshawk::flight_check::test {
namespace {

using ::testing::HasSubstr;

LiveSample live(double t_s, double x_m, double speed_m_s) {
  return {at(t_s, Vec3(x_m, 0.0, 1.0)), speed_m_s};
}

TEST(Discontinuity, IsNoneInAFlight) {
  Random random(3);
  double t_s = 10.0, x_m = 0.0, speed_m_s = 0.0;
  LiveSample last = live(t_s, x_m, speed_m_s);
  for (int k = 0; k < 5000; ++k) {
    const double dt_s = random.chance(0.02) ? random.uniform(0.01, 0.4) : 0.004;
    const double a_m_s2 = random.uniform(-8.0, 8.0);
    x_m += speed_m_s * dt_s + a_m_s2 * dt_s * dt_s / 2.0;
    speed_m_s = std::abs(speed_m_s + a_m_s2 * dt_s);
    t_s += dt_s;
    const LiveSample next = live(t_s, x_m + random.uniform(-0.02, 0.02), speed_m_s);
    EXPECT_EQ(discontinuity(last, next), std::nullopt) << k;
    last = next;
  }
}

TEST(Discontinuity, IsAJumpThatNoSpeedExplains) {
  EXPECT_THAT(*discontinuity(live(1.0, 0.0, 2.0), live(1.004, 3.0, 0.0)), HasSubstr("3.00 m"));
  EXPECT_TRUE(discontinuity(live(1.0, 0.0, 0.0), live(1.0, 0.2, 0.0)));
  EXPECT_TRUE(discontinuity(live(1.0, 0.0, 1.0), live(1.1, 0.5, 1.0)));
  EXPECT_FALSE(discontinuity(live(1.0, 0.0, 3.0), live(1.1, 0.35, 3.0)));
}

TEST(Discontinuity, IsAClockThatGoesBackAndAGap) {
  EXPECT_THAT(*discontinuity(live(5.0, 0.0, 0.0), live(0.0, 0.0, 0.0)), HasSubstr("went back"));
  EXPECT_THAT(*discontinuity(live(5.0, 0.0, 0.0), live(5.6, 0.0, 0.0)), HasSubstr("0.60 s"));
  EXPECT_FALSE(discontinuity(live(5.0, 0.0, 0.0), live(5.4, 0.0, 0.0)));
}

}  // namespace
}  // namespace goshawk::flight_check::test
