#include "goshawk/core/plan_request.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

namespace goshawk {
namespace {

PlanRequest valid() {
  PlanRequest request;
  request.id = 7;
  request.stamp_ns = 1'000'000'000;
  request.goal.position = Vec3(4, 5, 6);
  request.other_goals_map = {Vec3(1, 1, 1)};
  return request;
}

TEST(PlanRequest, IsValidAsItComes) {
  EXPECT_TRUE(check(valid()).ok());
  EXPECT_EQ(valid().unknown, UnknownSpace::as_configured);
  EXPECT_FALSE(valid().start_time_ns.has_value());
}

TEST(PlanRequest, IsRefusedWithAnyNumberNotFinite) {
  const std::vector<std::pair<std::string, std::function<double&(PlanRequest&)>>> numbers{
      {"start state", [](PlanRequest& r) -> double& { return r.start.position.y(); }},
      {"start state", [](PlanRequest& r) -> double& { return r.start.velocity.x(); }},
      {"goal state", [](PlanRequest& r) -> double& { return r.goal.acceleration.z(); }},
      {"other goal 0", [](PlanRequest& r) -> double& { return r.other_goals_map[0].x(); }},
      {"goal's yaw", [](PlanRequest& r) -> double& { return r.goal_yaw_rad; }},
      {"start's yaw", [](PlanRequest& r) -> double& { return r.start_yaw_rad; }},
      {"start's yaw rate", [](PlanRequest& r) -> double& { return r.start_yaw_rate_rad_s; }},
      {"deadline", [](PlanRequest& r) -> double& { return r.deadline_s; }},
      {"duration", [](PlanRequest& r) -> double& { return r.duration_s; }}};
  for (const auto& [name, number] : numbers) {
    for (const double bad : {double(NAN), double(INFINITY)}) {
      PlanRequest request = valid();
      number(request) = bad;
      const auto status = check(request);
      ASSERT_EQ(status.code(), ErrorCode::invalid_input) << name;
      EXPECT_NE(status.error().message.find(name), std::string::npos) << status.error().message;
    }
  }
}

TEST(PlanRequest, IsRefusedWithADeadlineOrADurationBelowZero) {
  PlanRequest request = valid();
  request.deadline_s = -0.5;
  EXPECT_EQ(check(request).code(), ErrorCode::invalid_input);
  request = valid();
  request.duration_s = -3.0;
  const auto status = check(request);
  ASSERT_EQ(status.code(), ErrorCode::invalid_input);
  EXPECT_EQ(status.error().message,
            "the duration of a plan request is -3 s: use 0 (as fast as the limits allow) or more");
}

TEST(PlanRequest, IsRefusedWithLimitsThatAreNone) {
  PlanRequest request = valid();
  request.limits.a_max_m_s2 = 0.0;
  EXPECT_EQ(check(request).code(), ErrorCode::invalid_limits);
}

TEST(PlanRequest, DeadlineIsCountedFromTheStamp) {
  PlanRequest request = valid();
  EXPECT_TRUE(check_deadline(request, std::int64_t{1} << 60).ok()) << "no deadline";
  request.deadline_s = 0.5;
  EXPECT_TRUE(check_deadline(request, 1'400'000'000).ok());
  const auto late = check_deadline(request, 1'600'000'000);
  ASSERT_EQ(late.code(), ErrorCode::deadline_exceeded);
  EXPECT_NE(late.error().message.find("0.5 s passed 0.1 s ago"), std::string::npos)
      << late.error().message;
}

}  // namespace
}  // namespace goshawk
