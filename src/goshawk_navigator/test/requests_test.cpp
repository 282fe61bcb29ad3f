// From a goal to a request and a committed trajectory, when all goes well.
#include "harness.hpp"

namespace goshawk::navigator {
namespace {

using testing::HasSubstr;

TEST(Navigator, FliesFromRestToTheGoalAndSaysSo) {
  Harness h;
  h.goal(kGoal);
  ASSERT_EQ(h.plans.size(), 1u);
  EXPECT_EQ(h.plans[0].id, 100u);
  EXPECT_EQ(h.plans[0].start.position, kHome);
  EXPECT_EQ(h.plans[0].start.velocity, Vec3::Zero());
  EXPECT_EQ(h.plans[0].goal.position, kGoal);
  EXPECT_EQ(h.last().state, State::planning);
  EXPECT_EQ(h.last().flown_id, 0u);
  h.answer();
  ASSERT_EQ(h.commits.size(), 1u);
  EXPECT_EQ(h.commits[0].start_time_ns(), h.now + kSecond / 20);
  EXPECT_EQ(h.last().state, State::flying);
  h.pass(3.9);
  EXPECT_EQ(h.navigator.state(), State::flying);
  h.pass(0.5);
  EXPECT_EQ(h.navigator.state(), State::arrived);
  EXPECT_EQ(h.last().flown_id, 100u) << "its end is held";
  EXPECT_EQ(h.plans.size(), 1u) << "one plan was enough";
}

TEST(Navigator, ReplansInFlightFromTheStateThatTheTrajectoryWillHave) {
  Harness h;
  h.goal(kGoal);
  h.answer();
  h.pass(1.5);
  h.goal(Vec3(2, 3, 1));
  ASSERT_EQ(h.plans.size(), 2u);
  EXPECT_EQ(h.last().id, h.plans[1].id) << "the newest request ...";
  EXPECT_EQ(h.last().flown_id, h.plans[0].id) << "... is not yet what is flown";
  const auto& [first, start_ns] = h.flown[0];
  const double switch_s = double(h.now - start_ns) * 1e-9 + 0.3;
  const FlatState expected = first.sample(switch_s);
  EXPECT_LT((h.plans[1].start.position - expected.position).norm(), 1e-9);
  EXPECT_LT((h.plans[1].start.velocity - expected.velocity).norm(), 1e-9);
  EXPECT_LT((h.plans[1].start.acceleration - expected.acceleration).norm(), 1e-9);
  EXPECT_GT(h.plans[1].start.velocity.norm(), 0.5) << "it was a moving start";
  h.pass(0.1);
  h.answer();
  ASSERT_EQ(h.commits.size(), 2u);
  EXPECT_NEAR(double(h.commits[1].start_time_ns() - start_ns) * 1e-9, switch_s, 1e-6);
  h.pass(5.0);
  EXPECT_EQ(h.navigator.state(), State::arrived);
}

TEST(Navigator, SaysWhenAndWithWhichHeadingAPlanBegins) {
  Harness h;
  h.yaw_rad = 0.75;
  h.pass(0.1);
  h.goal(kGoal);
  EXPECT_FALSE(h.plans[0].start_time_ns.has_value()) << "at rest, whenever";
  EXPECT_NEAR(h.plans[0].start_yaw_rad, 0.75, 1e-9);
  EXPECT_EQ(h.plans[0].start_yaw_rate_rad_s, 0.0);
  h.yaw_curve = YawCurve{4.0, {0.5, 1.0, 1.5}};  // 0.75 rad at 0 s, 0.125 rad/s
  h.answer();
  h.pass(1.0);
  h.goal(Vec3(2, 3, 1));
  ASSERT_TRUE(h.plans[1].start_time_ns.has_value());
  EXPECT_EQ(*h.plans[1].start_time_ns, h.now + 3 * kSecond / 10);
  const double in_flight_s = double(*h.plans[1].start_time_ns - h.flown[0].second) * 1e-9;
  EXPECT_NEAR(h.plans[1].start_yaw_rad, 0.75 + 0.125 * in_flight_s, 1e-9);
  EXPECT_NEAR(h.plans[1].start_yaw_rate_rad_s, 0.125, 1e-9);
}

TEST(Navigator, WithoutACurveOfYawAMovingStartLooksWhereTheVehicleDoes) {
  Harness h;
  h.goal(kGoal);
  h.answer();
  h.yaw_rad = -1.25;
  h.pass(1.0);
  h.goal(Vec3(2, 3, 1));
  ASSERT_TRUE(h.plans[1].start_time_ns.has_value());
  EXPECT_NEAR(h.plans[1].start_yaw_rad, -1.25, 1e-9);
  EXPECT_EQ(h.plans[1].start_yaw_rate_rad_s, 0.0);
}

TEST(Navigator, AtRestMeasuresHowFastTheVehicleTurns) {
  Harness h;
  RigidBodyState turning = at(kHome, Vec3::Zero(), 0.3);
  turning.angular_velocity_base = Vec3(0, 0, 0.4);
  h.navigator.on_odometry(turning, h.now);
  h.goal(kGoal);
  EXPECT_NEAR(h.plans[0].start_yaw_rate_rad_s, 0.4, 1e-12);
}

TEST(Navigator, ANewGoalOrATimeoutSupersedesTheOpenRequestAndAnAnswerDoesNot) {
  Harness h;
  h.goal(kGoal);
  EXPECT_EQ(h.plans[0].supersedes, 0u);
  h.goal(Vec3(2, 3, 1));
  EXPECT_EQ(h.plans[1].supersedes, h.plans[0].id) << "a new goal";
  h.pass(1.3);
  ASSERT_EQ(h.plans.size(), 3u);
  EXPECT_EQ(h.plans[2].supersedes, h.plans[1].id) << "nobody answered";
  h.fails(ErrorCode::no_map, StageRole::path_search);
  h.pass(0.5);
  ASSERT_EQ(h.plans.size(), 4u);
  EXPECT_EQ(h.plans[3].supersedes, 0u) << "the search said why not";
  h.answer();
  h.goal(kHome);
  EXPECT_EQ(h.plans[4].supersedes, 0u) << "the one before is flown";
}

TEST(Navigator, AsksForTheLimitsAndTheUnknownSpaceOfItsConfig) {
  Config config;
  config.v_max_m_s = 3.0;
  config.limit_norm = LimitNorm::horizontal_vertical;
  config.j_max_m_s3 = 20.0;
  config.v_max_vertical_m_s = 1.0;
  config.a_max_vertical_m_s2 = 1.5;
  config.unknown = UnknownSpace::blocked;
  Harness h;
  ASSERT_TRUE(h.navigator.reconfigure(config));
  h.goal(kGoal);
  const Limits& limits = h.plans[0].limits;
  EXPECT_EQ(limits.v_max_m_s, 3.0);
  EXPECT_EQ(limits.a_max_m_s2, 2.0);
  EXPECT_EQ(limits.norm, LimitNorm::horizontal_vertical);
  EXPECT_EQ(limits.j_max_m_s3, 20.0);
  EXPECT_EQ(limits.v_max_vertical_m_s, 1.0);
  EXPECT_EQ(limits.a_max_vertical_m_s2, 1.5);
  EXPECT_EQ(h.plans[0].unknown, UnknownSpace::blocked);
  EXPECT_TRUE(check(h.plans[0]).ok());
}

TEST(Navigator, AsksForALimitOfTheJerkInFlight) {
  const auto asked = [](double j_max, double j_max_in_flight) {
    Config config;
    config.j_max_m_s3 = j_max;
    config.j_max_in_flight_m_s3 = j_max_in_flight;
    Harness h;
    EXPECT_TRUE(h.navigator.reconfigure(wide(config)));
    h.goal(kGoal);
    EXPECT_EQ(h.plans.back().limits.j_max_m_s3, j_max);  // from rest
    h.answer();
    h.pass(0.5);
    h.goal(kHome);
    EXPECT_TRUE(h.plans.back().start_time_ns.has_value());
    return h.plans.back().limits.j_max_m_s3;
  };
  EXPECT_EQ(asked(0.0, 30.0), 30.0);
  EXPECT_EQ(asked(20.0, 30.0), 20.0);
  EXPECT_EQ(asked(40.0, 30.0), 30.0);
  EXPECT_EQ(asked(40.0, 0.0), 40.0);
  EXPECT_EQ(asked(0.0, 0.0), 0.0);
}

TEST(Navigator, CommitsWithTheGoalsHeadingAndTheMapOfTheProof) {
  Harness h;
  ASSERT_TRUE(h.navigator.on_goal(kGoal, 0.5, h.now).ok());
  h.take();
  h.answer();
  ASSERT_EQ(h.commits.size(), 1u);
  EXPECT_EQ(h.commits[0].id(), h.plans[0].id);
  EXPECT_EQ(h.commits[0].yaw_rad(), 0.5);
  EXPECT_EQ(h.commits[0].map_version(), 5u);
  EXPECT_FALSE(h.commits[0].stop().has_value());
}

TEST(Navigator, RefusesAGoalThatIsNotFiniteAndStaysAsItWas) {
  Harness h;
  h.goal(kGoal);
  h.answer();
  h.pass(1.0);
  EXPECT_EQ(h.navigator.on_goal(Vec3(NAN, 0, 0), 0.0, h.now).code(), ErrorCode::invalid_input);
  EXPECT_EQ(h.navigator.on_goal(kHome, INFINITY, h.now).code(), ErrorCode::invalid_input);
  h.pass(4.0);
  EXPECT_EQ(h.navigator.state(), State::arrived);
}

TEST(Navigator, SameEventsSameOrders) {
  const auto run = [] {
    Harness h;
    h.goal(kGoal);
    h.answer();
    h.pass(1.5);
    h.goal(kHome);
    h.answer();
    h.pass(9.0);
    std::vector<double> numbers;
    for (const auto& p : h.plans)
      numbers.insert(numbers.end(), p.start.position.begin(), p.start.position.end());
    for (const auto& c : h.commits) numbers.push_back(double(c.start_time_ns()));
    for (const auto& s : h.states) numbers.push_back(double(s.state));
    return numbers;
  };
  EXPECT_EQ(run(), run());
}

TEST(Navigator, LimitsOfTimeChangeBetweenTwoRequestsAndAllElseIsRefused) {
  Harness h;
  h.goal(kGoal);
  Config config;
  config.plan_timeout_s = 3.0;
  config.max_attempts = 2;
  ASSERT_TRUE(h.navigator.reconfigure(config));
  h.pass(2.0);  // the open request has longer now
  EXPECT_EQ(h.plans.size(), 1u);
  h.pass(1.5);
  ASSERT_EQ(h.plans.size(), 2u);
  EXPECT_EQ(h.plans[1].deadline_s, 3.0);
  h.pass(3.5);
  EXPECT_EQ(h.last().state, State::failed);

  Config bad = config;
  bad.max_attempts = 0;
  EXPECT_THAT(h.navigator.reconfigure(bad).error().message, HasSubstr("max_attempts"));
  bad = config;
  bad.rest_speed_m_s = 1.0;
  EXPECT_THAT(h.navigator.reconfigure(bad).error().message, HasSubstr("rest_speed_m_s cannot"));
}

}  // namespace
}  // namespace goshawk::navigator
