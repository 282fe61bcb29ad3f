#include "record.hpp"

#include <gtest/gtest.h>

namespace goshawk::league {
namespace {

constexpr Limits kLimits{
    .v_max_m_s = 5.0, .a_max_m_s2 = 20.0, .norm = LimitNorm::per_axis, .j_max_m_s3 = 100.0};

Moment moment(double t_s, double x_m, const FlatState& reference = {}) {
  Moment m{.t_s = t_s, .vehicle = {}, .reference = reference};
  m.vehicle.position_map = Vec3(x_m, 0.0, 2.0);
  m.vehicle.velocity_map = Vec3(3.0, 4.0, 0.0);
  return m;
}

TEST(Record, AddsUpLengthSpeedAndJerk) {
  Outcome outcome;
  const FlatState reference{.jerk = Vec3(30.0, 40.0, 0.0)};
  for (int i = 0; i <= 10; ++i) record(moment(0.1 * i, 0.5 * i, reference), kLimits, outcome);
  EXPECT_NEAR(outcome.length_m, 5.0, 1e-12);
  EXPECT_NEAR(outcome.jerk_m_s2, 50.0, 1e-9);
  EXPECT_NEAR(outcome.top_speed_m_s, 5.0, 1e-12);
  EXPECT_EQ(outcome.violations, 0);
}

TEST(Record, CountsWhatIsBeyondALimit) {
  Outcome outcome;
  record(moment(0.0, 0.0, {.velocity = Vec3(5.0, 5.0, 5.0)}), kLimits, outcome);
  EXPECT_EQ(outcome.violations, 0) << "each axis apart";
  record(moment(0.1, 0.0, {.velocity = Vec3(5.01, 0.0, 0.0)}), kLimits, outcome);
  record(moment(0.2, 0.0, {.acceleration = Vec3(0.0, -20.1, 0.0)}), kLimits, outcome);
  record(moment(0.3, 0.0, {.jerk = Vec3(80.0, 80.0, 0.0)}), kLimits, outcome);
  EXPECT_EQ(outcome.violations, 3);
  EXPECT_NEAR(outcome.worst_use, 1.13, 0.01);
}

TEST(Record, TheTrueWorldDecidesWhetherItWasTouched) {
  Scene scene;
  scene.solids = {{.center_map = Vec3(2.0, 0.3, 2.0), .size_m = Vec3(0.2, 0.2, 4.0)}};
  Outcome past;
  for (int i = 0; i <= 100; ++i) record(moment(0.01 * i, 0.05 * i), kLimits, past);
  ASSERT_TRUE(judge(scene, past));
  EXPECT_FALSE(past.verdict.touched);
  EXPECT_NEAR(past.verdict.clearance_m, 0.3 - 0.1 - 0.15, 2e-3);

  scene.solids[0].center_map.y() = 0.2;
  ASSERT_TRUE(judge(scene, past));
  EXPECT_TRUE(past.verdict.touched);
}

TEST(Record, WithoutAnySolidNothingCanBeJudged) {
  Outcome outcome;
  record(moment(0.0, 0.0), kLimits, outcome);
  EXPECT_EQ(judge({}, outcome).code(), ErrorCode::map_empty);
}

}  // namespace
}  // namespace goshawk::league
