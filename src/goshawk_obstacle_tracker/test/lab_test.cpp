// The tracker in a simulated hall, judged against the truth. The same case gives the same figures:
// limits leave room for other compilers, not for chance.
#include "goshawk/obstacle_tracker_lab/lab.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <limits>

namespace goshawk::obstacle_tracker {
namespace {

TEST(Lab, APersonWhoCrossesIsFoundFollowedAndWithinTheBound) {
  LabCase c{.movers = {crossing_person(1, 10.0, 2.0)}, .sensor = lab_lidar()};
  c.duration_s = 9.0;
  const auto result = run_lab(c);
  ASSERT_TRUE(result) << result.error().message;
  const Figures& f = result->figures;
  EXPECT_GT(f.recall, 0.8);
  EXPECT_GT(f.precision, 0.9);
  EXPECT_LE(f.switches, 1);
  EXPECT_LT(f.position_error_m, 0.35);
  EXPECT_LT(f.velocity_error_m_s, 0.7);
  ASSERT_FALSE(f.delays_s.empty());
  EXPECT_LT(*std::ranges::max_element(f.delays_s), 0.8);
  EXPECT_EQ(f.never_told, 0);
  EXPECT_GT(f.in_bound[0], 0.9);
  EXPECT_GT(f.in_bound[2], 0.85);
}

TEST(Lab, WhereNothingMovesAHoveringVehicleIsToldNothing) {
  LabCase c{.sensor = lab_lidar()};
  c.duration_s = 4.0;
  const auto result = run_lab(c);
  ASSERT_TRUE(result) << result.error().message;
  EXPECT_GT(result->scans, 30);
  EXPECT_EQ(result->figures.told, 0);
}

TEST(Lab, WhatIsWrongIsSaid) {
  LabCase c{.sensor = lab_lidar()};
  c.tracker.cell_m = 0.0;
  EXPECT_EQ(run_lab(c).code(), ErrorCode::invalid_parameter);
  c = {.sensor = lab_lidar()};
  c.sensor.pattern.channels = 0;
  EXPECT_EQ(run_lab(c).code(), ErrorCode::invalid_parameter);
}

}  // namespace
}  // namespace goshawk::obstacle_tracker
