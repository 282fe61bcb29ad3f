#include "goshawk/tracker/admission.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <functional>

#include "trajectories.hpp"

namespace goshawk::tracker {
namespace {

using testing::HasSubstr;

CommittedTrajectory good() {
  Random random(1);
  return random_trajectory(random, {0, 0, 1}, 4, 1.5, 1.5);
}

struct Case {
  const char* name;
  ErrorCode code;
  const char* sentence;
  std::function<void(CommittedTrajectory&)> spoil;
};

TEST(Admission, ACertifiedTrajectoryIsAdmitted) {
  const auto status = admit(good(), Config{});
  EXPECT_TRUE(status) << status.error().message;
}

TEST(Admission, EachWayToBeWrongIsRefusedWithItsCodeAndASentence) {
  const double nan = std::nan("");
  const std::vector<Case> cases{
      {"no piece", ErrorCode::invalid_input, "no piece",
       [](auto& c) { c.trajectory.pieces.clear(); }},
      {"NaN point", ErrorCode::invalid_input, "not finite",
       [&](auto& c) { c.trajectory.pieces[1].control_points(0, 2) = nan; }},
      {"zero duration", ErrorCode::invalid_input, "above zero",
       [](auto& c) { c.trajectory.pieces[0].duration_s = 0.0; }},
      {"NaN goal", ErrorCode::invalid_input, "start or goal",
       [&](auto& c) { c.goal.velocity.x() = nan; }},
      {"NaN yaw", ErrorCode::invalid_input, "yaw", [&](auto& c) { c.yaw_rad = nan; }},
      {"start time", ErrorCode::invalid_input, "supported range",
       [](auto& c) { c.start_time_ns = std::numeric_limits<std::int64_t>::min(); }},
      {"limits", ErrorCode::invalid_limits, "v_max", [](auto& c) { c.limits.v_max_m_s = -1.0; }},
      {"no polytope", ErrorCode::invalid_input, "names polytope 0 of 0",
       [](auto& c) { c.polytopes.clear(); }},
      {"wrong polytope", ErrorCode::invalid_input, "names polytope -1",
       [](auto& c) { c.trajectory.pieces[0].polytope = -1; }},
      {"empty polytope", ErrorCode::invalid_input, "polytope 0",
       [](auto& c) { c.polytopes[0] = Polytope{}; }},
      {"NaN polytope", ErrorCode::invalid_input, "polytope 0",
       [&](auto& c) { c.polytopes[0].half_spaces[0].offset_m = nan; }},
      {"outside", ErrorCode::not_certified, "position",
       [](auto& c) {
         c.polytopes[0] = Polytope::box({-9, -9, 0}, {9, 0.5, 9});
       }},
      {"too fast", ErrorCode::not_certified, "velocity",
       [](auto& c) { c.limits.v_max_m_s *= 0.9; }},
      {"too hard", ErrorCode::not_certified, "acceleration",
       [](auto& c) { c.limits.a_max_m_s2 *= 0.5; }},
      {"broken joint", ErrorCode::not_certified, "joint",
       [](auto& c) {
         for (int j = 3; j < 6; ++j) c.trajectory.pieces[0].control_points(2, j) += 0.01;
       }},
      {"other start", ErrorCode::not_certified, "start",
       [](auto& c) { c.start.position.x() += 0.01; }},
      {"other goal", ErrorCode::not_certified, "goal",
       [](auto& c) { c.goal.position.x() += 0.01; }},
      {"moving end", ErrorCode::not_certified, "rest",
       [](auto& c) {
         c.trajectory.pieces.pop_back();
         certify_as_is(c);
       }},
      {"beyond thrust", ErrorCode::trajectory_infeasible, "lower a_max", [](auto& c) {
         for (auto& piece : c.trajectory.pieces) piece.duration_s *= 0.3;
         certify_as_is(c);
       }}};
  for (const auto& test : cases) {
    auto committed = good();
    test.spoil(committed);
    const auto status = admit(committed, Config{});
    ASSERT_FALSE(status) << test.name;
    EXPECT_EQ(status.code(), test.code) << test.name << ": " << status.error().message;
    EXPECT_THAT(status.error().message, HasSubstr(test.sentence)) << test.name;
    EXPECT_THAT(status.error().message, HasSubstr("trajectory " + std::to_string(committed.id)));
  }
}

TEST(Admission, LimitsOnEachAxisAreRecomputedAsSuch) {
  auto committed = straight_line({0, 0, 0}, {2, 2, 2}, 4.0);
  const auto euclidean = committed.limits;
  committed.limits.v_max_m_s = euclidean.v_max_m_s / std::sqrt(3.0);
  committed.limits.a_max_m_s2 = euclidean.a_max_m_s2 / std::sqrt(3.0);
  EXPECT_EQ(admit(committed, Config{}).code(), ErrorCode::not_certified);
  committed.limits.norm = LimitNorm::per_axis;
  EXPECT_TRUE(admit(committed, Config{}));
}

}  // namespace
}  // namespace goshawk::tracker
