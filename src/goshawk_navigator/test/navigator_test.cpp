#include "goshawk/navigator/navigator.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace goshawk::navigator {
namespace {

using testing::HasSubstr;
constexpr std::int64_t kSecond = 1'000'000'000;
constexpr std::int64_t kStep = kSecond / 50;
const Vec3 kHome(0, 0, 1);
const Vec3 kGoal(4, 0, 1);

Error ok() {
  return {ErrorCode::ok, ""};
}

RigidBodyState at(const Vec3& position, const Vec3& velocity = Vec3::Zero(), double yaw_rad = 0.0) {
  return {.position_map = position,
          .velocity_map = velocity,
          .q_map_base = Quaternion(Eigen::AngleAxisd(yaw_rad, Vec3::UnitZ()))};
}

/// Plays the other stages and the vehicle.
class Harness {
 public:
  explicit Harness(const Config& config = {}) : navigator(config, 100) {
    navigator.on_odometry(at(kHome), now);
  }

  void goal(const Vec3& g) {
    ASSERT_TRUE(navigator.on_goal(g, 0.0, now).ok());
    take();
  }

  void take() {
    for (auto& order : navigator.take_orders()) {
      if (auto* plan = std::get_if<PlanRequest>(&order)) plans.push_back(*plan);
      if (auto* commit = std::get_if<CommittedTrajectory>(&order)) commits.push_back(*commit);
      if (auto* state = std::get_if<StateOrder>(&order)) states.push_back(*state);
    }
  }

  /// Time passes; the vehicle is where the newest committed trajectory has it.
  void pass(double seconds) {
    const std::int64_t end = now + std::int64_t(seconds * 1e9);
    while (now < end) {
      now += kStep;
      if (odometry_comes) {
        const FlatState s = vehicle();
        navigator.on_odometry(at(s.position + offset, s.velocity, yaw_rad), now);
      }
      navigator.tick(now);
      take();
    }
  }

  Commitment solve(const PlanRequest& request, double duration_s = 4.0) {
    Trajectory line{{BezierPiece::between(request.start, request.goal, duration_s)}};
    const std::vector room{Polytope::box(Vec3::Constant(-99), Vec3::Constant(99))};
    const Limits wide{.v_max_m_s = 99.0, .a_max_m_s2 = 999.0};
    return {.id = request.id,
            .nominal = certify(std::move(line), room, wide, request.start, request.goal).value(),
            .map_version = 5,
            .yaw_curve = yaw_curve};
  }

  /// All stages answer the newest request.
  void answer(double duration_s = 4.0) {
    const PlanRequest request = plans.back();
    for (const StageRole stage :
         {StageRole::path_search, StageRole::corridor_builder, StageRole::trajectory_optimizer}) {
      navigator.on_report(request.id, stage, ok(), now);
    }
    const std::size_t before = commits.size();
    navigator.on_trajectory(solve(request, duration_s), now);
    take();
    if (commits.size() > before) {
      flown.push_back({commits.back().flown(), commits.back().start_time_ns()});
    }
  }

  FlatState vehicle() const {
    FlatState s;
    s.position = kHome;
    for (const auto& [trajectory, start_ns] : flown) {
      if (now < start_ns) break;
      s = trajectory.sample(std::min(double(now - start_ns) * 1e-9, trajectory.duration_s()));
    }
    return s;
  }

  StateOrder last() const { return states.back(); }

  Navigator navigator;
  std::int64_t now = 10 * kSecond;
  bool odometry_comes = true;
  Vec3 offset = Vec3::Zero();
  double yaw_rad = 0.0;
  std::optional<YawCurve> yaw_curve;  // of the answers
  std::vector<PlanRequest> plans;
  std::vector<CommittedTrajectory> commits;
  std::vector<StateOrder> states;
  std::vector<std::pair<Trajectory, std::int64_t>> flown;
};

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
  h.navigator.on_report(h.plans[2].id, StageRole::path_search, {ErrorCode::no_map, "no map"},
                        h.now);
  h.pass(0.3);
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
  Harness h(config);
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

TEST(Navigator, DoesNotCommitATrajectoryThatDoesNotEndAtRest) {
  Harness h;
  h.goal(kGoal);
  PlanRequest through = h.plans[0];
  through.goal.velocity = Vec3(1, 0, 0);
  h.navigator.on_trajectory(h.solve(through), h.now);
  h.take();
  EXPECT_TRUE(h.commits.empty());
  EXPECT_EQ(h.last().state, State::failed);
  EXPECT_EQ(h.last().reason.code, ErrorCode::not_certified);
  EXPECT_THAT(h.last().reason.message, HasSubstr("does not end at rest"));
}

TEST(Navigator, DropsAPlanThatCameTooLateAndAsksWithMoreLead) {
  Harness h;
  h.goal(kGoal);
  h.answer(8.0);
  h.pass(2.0);
  h.goal(Vec3(2, 3, 1));
  h.pass(0.4);  // the moment of the switch has passed
  h.answer();
  EXPECT_EQ(h.commits.size(), 1u) << "a trajectory that begins in the past is not committed";
  h.pass(0.3);
  ASSERT_EQ(h.plans.size(), 3u);
  h.pass(0.4);  // too late for 0.3 s, early enough for 0.6 s
  h.answer();
  EXPECT_EQ(h.commits.size(), 2u);
}

TEST(Navigator, AFailedReplanLeavesTheVehicleOnItsTrajectory) {
  Harness h;
  h.goal(kGoal);
  h.answer();
  h.pass(1.0);
  h.goal(Vec3(90, 0, 1));
  h.navigator.on_report(h.plans.back().id, StageRole::path_search,
                        {ErrorCode::goal_outside, "goal is outside the map"}, h.now);
  h.take();
  EXPECT_EQ(h.last().state, State::failed);
  EXPECT_EQ(h.last().reason.code, ErrorCode::goal_outside);
  EXPECT_THAT(h.last().reason.message, HasSubstr("path_search: goal is outside"));
  h.pass(10.0);
  EXPECT_EQ(h.commits.size(), 1u);
  EXPECT_EQ(h.navigator.state(), State::failed) << "it rests at the earlier goal, not at this one";
  h.goal(kHome);
  EXPECT_EQ(h.plans.back().start.position, kGoal);
}

TEST(Navigator, NamesTheStageThatIsSilentAndGivesUpInTheEnd) {
  Config config;
  config.max_attempts = 3;
  Harness h(config);
  h.goal(kGoal);
  h.navigator.on_report(h.plans.back().id, StageRole::path_search, ok(), h.now);
  h.pass(1.5);
  EXPECT_EQ(h.plans.size(), 2u) << "asked again";
  h.navigator.on_report(h.plans.back().id, StageRole::path_search, ok(), h.now);
  h.pass(1.2);
  h.navigator.on_report(h.plans.back().id, StageRole::path_search, ok(), h.now);
  h.pass(5.0);
  EXPECT_EQ(h.plans.size(), 3u);
  EXPECT_EQ(h.last().state, State::failed);
  EXPECT_EQ(h.last().reason.code, ErrorCode::stage_silent);
  EXPECT_THAT(h.last().reason.message, HasSubstr("corridor_builder did not answer"));
}

TEST(Navigator, FliesWhenARestartedStageAnswersALaterAttempt) {
  Harness h;
  h.goal(kGoal);
  h.pass(2.5);
  ASSERT_GE(h.plans.size(), 2u);
  h.navigator.on_trajectory(h.solve(h.plans[0]), h.now);
  h.take();
  EXPECT_TRUE(h.commits.empty()) << "an answer to a request that was given up is ignored";
  h.answer();
  EXPECT_EQ(h.navigator.state(), State::flying);
}

TEST(Navigator, AsksAgainIfTheMapHasNotComeYetButNotIfThereIsNoPath) {
  Harness h;
  h.goal(kGoal);
  h.navigator.on_report(h.plans.back().id, StageRole::path_search, {ErrorCode::no_map, "no map"},
                        h.now);
  h.pass(0.5);
  EXPECT_EQ(h.plans.size(), 2u);
  h.navigator.on_report(h.plans.back().id, StageRole::path_search, {ErrorCode::no_path, "cut off"},
                        h.now);
  h.pass(3.0);
  EXPECT_EQ(h.plans.size(), 2u);
  EXPECT_EQ(h.last().reason.code, ErrorCode::no_path);
}

TEST(Navigator, PlansAgainFromRestIfTheTrackerRefuses) {
  Harness h;
  h.goal(kGoal);
  h.answer();
  const std::uint64_t refused = h.commits[0].id();
  h.flown.clear();  // the vehicle stays where it is
  h.navigator.on_report(refused, StageRole::tracker, {ErrorCode::not_at_start, "0.9 m away"},
                        h.now);
  h.take();
  EXPECT_EQ(h.last().state, State::planning);
  EXPECT_THAT(h.last().reason.message, HasSubstr("0.9 m away"));
  h.pass(0.5);
  ASSERT_EQ(h.plans.size(), 2u);
  EXPECT_EQ(h.plans[1].goal.position, kGoal);
  h.answer();
  h.pass(5.0);
  EXPECT_EQ(h.navigator.state(), State::arrived);
}

TEST(Navigator, WithoutOdometryNamesWhatIsMissing) {
  Harness h;
  h.odometry_comes = false;
  h.pass(1.0);
  h.goal(kGoal);
  h.pass(6.0);
  EXPECT_TRUE(h.plans.empty());
  EXPECT_EQ(h.last().state, State::failed);
  EXPECT_EQ(h.last().reason.code, ErrorCode::tracking_lost);
  EXPECT_THAT(h.last().reason.message, HasSubstr("odometry"));
}

TEST(Navigator, WaitsForOdometryThatComesALittleAfterTheGoal) {
  Harness h;
  h.odometry_comes = false;
  h.pass(1.0);
  h.goal(kGoal);
  h.pass(1.0);
  EXPECT_TRUE(h.plans.empty());
  h.odometry_comes = true;
  h.pass(0.1);
  EXPECT_EQ(h.plans.size(), 1u);
}

TEST(Navigator, DoesNotPlanFromRestWhileTheVehicleMovesByItself) {
  Harness h;
  h.navigator.on_odometry(at(kHome, Vec3(1, 0, 0)), h.now);
  h.goal(kGoal);
  EXPECT_TRUE(h.plans.empty());
  h.pass(0.1);  // the harness' vehicle is at rest
  EXPECT_EQ(h.plans.size(), 1u);
}

TEST(Navigator, AVehicleThatEndsElsewhereHasNotArrived) {
  Harness h;
  h.goal(kGoal);
  h.answer();
  h.offset = Vec3(0, 0.5, 0);
  h.pass(12.0);
  EXPECT_EQ(h.navigator.state(), State::failed);
  EXPECT_EQ(h.last().reason.code, ErrorCode::tracking_lost);
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
