#include "goshawk/plant/world_time.hpp"

#include <gtest/gtest.h>

namespace goshawk::plant {
namespace {

TEST(WorldTime, PassesAsOutsideButForAPauseThatItDoesNotLiveThrough) {
  EXPECT_EQ(world_time_s(0.004, 0.004), 0.004);
  EXPECT_EQ(world_time_s(0.09, 0.004), 0.09) << "late, not stopped";
  EXPECT_EQ(world_time_s(0.11, 0.004), 0.004);
  EXPECT_EQ(world_time_s(8.0, 0.004), 0.004);
  EXPECT_EQ(world_time_s(-1.0, 0.004), 0.0);
  EXPECT_EQ(world_time_s(0.2, 0.2), 0.2) << "as slow as it is meant to be";
}

}  // namespace
}  // namespace goshawk::plant
