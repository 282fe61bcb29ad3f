#include "goshawk/visualization/speed_color.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace goshawk::visualization {
namespace {

TEST(SpeedColor, GoesFromBlueToOrangeWithoutAJump) {
  EXPECT_GT(speed_color(0.0).z(), 0.9);
  EXPECT_GT(speed_color(1.0).x(), 0.9);
  EXPECT_LT(speed_color(1.0).z(), 0.2);
  for (int k = 0; k < 1000; ++k) {
    const Vec3 step = speed_color((k + 1) / 1000.0) - speed_color(k / 1000.0);
    EXPECT_LT(step.norm(), 0.01);
    EXPECT_LE(step.z() - step.x(), 1e-9);  // never back towards blue
  }
}

TEST(SpeedColor, OfWhatIsNoRatioIsThatOfAnEnd) {
  EXPECT_EQ(speed_color(-3.0), speed_color(0.0));
  EXPECT_EQ(speed_color(7.0), speed_color(1.0));
  EXPECT_EQ(speed_color(std::nan("")), speed_color(0.0));
}

}  // namespace
}  // namespace goshawk::visualization
