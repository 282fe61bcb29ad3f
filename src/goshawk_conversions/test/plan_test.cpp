#include "goshawk/conversions/plan.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "goshawk/core/random.hpp"

namespace goshawk::conversions {
namespace {

namespace msg = goshawk_msgs::msg;
using testing::HasSubstr;
constexpr double kNotANumber = std::numeric_limits<double>::quiet_NaN();

Vec3 random_vector(Random& random) {
  return {random.uniform(-9, 9), random.uniform(-9, 9), random.uniform(-9, 9)};
}

msg::PlanRequest valid_request() {
  PlanRequest request;
  request.id = 7;
  request.stamp_ns = 5'000'000'000;
  request.start.position = Vec3(1, 2, 3);
  request.goal.position = Vec3(4, 5, 6);
  return to_msg(request);
}

PlanRequest request_with_every_field() {
  Random random(3);
  PlanRequest r;
  r.id = 42;
  r.stamp_ns = 123'456'789'012;
  r.start_time_ns = 123'999'999'999;
  r.start = {random_vector(random), random_vector(random), random_vector(random), Vec3::Zero()};
  r.start_yaw_rad = -0.75;
  r.start_yaw_rate_rad_s = 0.125;
  r.goal.position = random_vector(random);
  r.other_goals_map = {random_vector(random), random_vector(random)};
  r.goal_yaw_rad = 1.5;
  r.deadline_s = 0.25;
  r.duration_s = 12.5;
  r.limits = {.v_max_m_s = 3.0,
              .a_max_m_s2 = 4.0,
              .norm = LimitNorm::horizontal_vertical,
              .j_max_m_s3 = 5.0,
              .v_max_vertical_m_s = 6.0,
              .a_max_vertical_m_s2 = 7.0};
  r.supersedes = 41;
  r.unknown = UnknownSpace::costly;
  return r;
}

TEST(PlanRequestMessage, SurvivesTheRoundTrip) {
  const PlanRequest in = request_with_every_field();
  const auto out = from_msg(to_msg(in));
  ASSERT_TRUE(out.ok()) << out.error().message;
  EXPECT_EQ(out->id, in.id);
  EXPECT_EQ(out->stamp_ns, in.stamp_ns);
  EXPECT_EQ(out->start_time_ns, in.start_time_ns);
  EXPECT_EQ(largest_difference(out->start, in.start), 0.0);
  EXPECT_EQ(out->start_yaw_rad, in.start_yaw_rad);
  EXPECT_EQ(out->start_yaw_rate_rad_s, in.start_yaw_rate_rad_s);
  EXPECT_EQ(out->goal.position, in.goal.position);
  EXPECT_EQ(out->other_goals_map, in.other_goals_map);
  EXPECT_EQ(out->goal_yaw_rad, in.goal_yaw_rad);
  EXPECT_EQ(out->deadline_s, in.deadline_s);
  EXPECT_EQ(out->duration_s, in.duration_s);
  EXPECT_EQ(out->supersedes, in.supersedes);
  EXPECT_EQ(out->unknown, in.unknown);
}

TEST(PlanRequestMessage, CarriesEveryLimit) {
  const PlanRequest in = request_with_every_field();
  const auto out = from_msg(to_msg(in));
  ASSERT_TRUE(out.ok()) << out.error().message;
  EXPECT_EQ(out->limits.v_max_m_s, in.limits.v_max_m_s);
  EXPECT_EQ(out->limits.a_max_m_s2, in.limits.a_max_m_s2);
  EXPECT_EQ(out->limits.norm, in.limits.norm);
  EXPECT_EQ(out->limits.j_max_m_s3, in.limits.j_max_m_s3);
  EXPECT_EQ(out->limits.v_max_vertical_m_s, in.limits.v_max_vertical_m_s);
  EXPECT_EQ(out->limits.a_max_vertical_m_s2, in.limits.a_max_vertical_m_s2);
}

TEST(PlanRequestMessage, WithoutAStartTimeIsAtRest) {
  EXPECT_FALSE(from_msg(valid_request())->start_time_ns.has_value());
}

TEST(PlanRequestMessage, IsRefusedInAnotherFrame) {
  auto m = valid_request();
  m.header().frame_id("odom_ned");
  const auto result = from_msg(m);
  EXPECT_EQ(result.code(), ErrorCode::wrong_frame);
  EXPECT_THAT(result.error().message, HasSubstr("odom_ned"));
}

TEST(PlanRequestMessage, IsCheckedAsARequest) {
  auto m = valid_request();
  m.start().position().y(kNotANumber);
  EXPECT_EQ(from_msg(m).code(), ErrorCode::invalid_input);
  m = valid_request();
  m.deadline(-1.0);
  EXPECT_EQ(from_msg(m).code(), ErrorCode::invalid_input);
  for (const double bad : {0.0, -1.0, kNotANumber, HUGE_VAL}) {
    m = valid_request();
    m.limits().a_max(bad);
    const auto result = from_msg(m);
    EXPECT_EQ(result.code(), ErrorCode::invalid_limits);
    EXPECT_THAT(result.error().message, HasSubstr("a_max"));
  }
}

TEST(PlanRequestMessage, IsRefusedWithAConstantThatDoesNotExist) {
  auto m = valid_request();
  m.limits().norm(3);
  EXPECT_EQ(from_msg(m).code(), ErrorCode::invalid_limits);
  m = valid_request();
  m.unknown(4);
  EXPECT_EQ(from_msg(m).code(), ErrorCode::invalid_input);
}

TEST(PathMessage, GivesItsWaypointsIfTheyAreALine) {
  msg::Path m;
  m.header(make_header(0));
  m.waypoints(to_points({Vec3(1, 2, 3), Vec3(4, 5, 6)}));
  const auto waypoints = waypoints_of(m);
  ASSERT_TRUE(waypoints.ok());
  EXPECT_EQ(waypoints->back(), Vec3(4, 5, 6));
  m.waypoints()[1].z(kNotANumber);
  EXPECT_EQ(waypoints_of(m).code(), ErrorCode::invalid_input);
  m.waypoints().resize(1);
  EXPECT_EQ(waypoints_of(m).code(), ErrorCode::invalid_input);
  m.header().frame_id("odom");
  EXPECT_EQ(waypoints_of(m).code(), ErrorCode::wrong_frame);
}

TEST(PolytopeMessage, SurvivesTheRoundTripWithItsInterval) {
  Polytope in = Polytope::box(Vec3(0, -1, 2), Vec3(3, 4, 5));
  in.add(Vec3(0.6, 0.8, 0.0), 2.5);
  in.valid_from_s = 0.5;
  in.valid_until_s = 4.0;
  const auto m = to_msg(in);
  EXPECT_EQ(m.normals().size(), 21u);
  const auto out = from_msg(m);
  ASSERT_TRUE(out.ok());
  EXPECT_EQ(*out, in);
}

TEST(PolytopeMessage, WithSizesThatDisagreeIsRefused) {
  auto m = to_msg(Polytope::box(Vec3::Zero(), Vec3::Ones()));
  m.normals().pop_back();
  EXPECT_EQ(from_msg(m).code(), ErrorCode::invalid_input);
}

msg::Corridor valid_corridor() {
  msg::Corridor m;
  m.header(make_header(0));
  m.waypoints(to_points({Vec3(0.5, 0.5, 0.5), Vec3(1.5, 0.5, 0.5), Vec3(2.5, 0.5, 0.5)}));
  m.polytopes(to_msg(std::vector{Polytope::box(Vec3(0, 0, 0), Vec3(2, 1, 1)),
                                 Polytope::box(Vec3(1, 0, 0), Vec3(3, 1, 1))}));
  m.min_overlap_radius(99.0);
  return m;
}

TEST(CorridorMessage, IsTakenWithOverlapsOfOurOwn) {
  const auto corridor = from_msg(valid_corridor());
  ASSERT_TRUE(corridor.ok()) << corridor.error().message;
  EXPECT_TRUE(corridor->check().ok());
  EXPECT_EQ(corridor->waypoints_map.size(), 3u);
  EXPECT_NEAR(corridor->min_overlap_radius_m(), 0.5, 1e-9);
}

TEST(CorridorMessage, ThatMakesNoSenseDoesNotPassItsCheck) {
  auto m = valid_corridor();
  m.waypoints().pop_back();
  EXPECT_EQ(from_msg(m)->check().code(), ErrorCode::invalid_input);
  m = valid_corridor();
  m.polytopes()[0].normals()[0] = 2.0;
  EXPECT_EQ(from_msg(m)->check().code(), ErrorCode::invalid_input);
  m = valid_corridor();
  m.polytopes()[1].offsets()[2] = kNotANumber;
  EXPECT_EQ(from_msg(m)->check().code(), ErrorCode::invalid_input);
  m = valid_corridor();
  m.header().frame_id("odom");
  EXPECT_EQ(from_msg(m).code(), ErrorCode::wrong_frame);
}

const std::vector<Polytope> kRoom{Polytope::box(Vec3(-1, -1, -1), Vec3(3, 1, 1))};

msg::BezierTrajectory trajectory_to(const FlatState& goal, double duration_s) {
  PlanRequest request;
  request.id = 12;
  request.goal = goal;
  const Trajectory trajectory{{BezierPiece::between(request.start, goal, duration_s)}};
  msg::BezierTrajectory m;
  m.header(make_header(0));
  m.request(to_msg(request));
  m.pieces(to_msg(trajectory));
  m.polytopes(to_msg(kRoom));
  return m;
}

FlatState at(double x, double v = 0.0) {
  FlatState state;
  state.position.x() = x;
  state.velocity.x() = v;
  return state;
}

TEST(TrajectoryMessage, IsTakenWithACertificateOfOurOwn) {
  const auto received = from_msg(trajectory_to(at(1), 10.0));
  ASSERT_TRUE(received.ok()) << received.error().message;
  EXPECT_TRUE(received->certificate().holds());
  EXPECT_LT(received->certificate().position_m, 0.0);
  EXPECT_EQ(received->goal().position, Vec3(1, 0, 0));
  EXPECT_EQ(received->polytopes(), kRoom);
}

TEST(TrajectoryMessage, IsRefusedIfTheCertificateFailsWhateverItClaims) {
  auto m = trajectory_to(at(1), 10.0);
  m.pieces()[0].control_points()[3].y(5.0);  // out of the polytope
  m.certificate().position(-1.0);
  const auto outside = from_msg(m);
  ASSERT_EQ(outside.code(), ErrorCode::not_certified);
  EXPECT_THAT(outside.error().message, HasSubstr("trajectory of request 12: the certificate"));
  m = trajectory_to(at(1), 10.0);
  m.pieces()[0].duration(0.1);  // far too fast
  EXPECT_EQ(from_msg(m).code(), ErrorCode::not_certified);
  m = trajectory_to(at(1), 10.0);
  m.request().goal().position().x(1.5);  // ends elsewhere
  EXPECT_EQ(from_msg(m).code(), ErrorCode::not_certified);
  m = trajectory_to(at(1), 10.0);
  m.polytopes()[0].valid_until(9.0);  // the piece lasts longer
  EXPECT_EQ(from_msg(m).code(), ErrorCode::not_certified);
}

TEST(TrajectoryMessage, ThatMakesNoSenseIsRefused) {
  const auto code = [](auto&& harm) {
    auto m = trajectory_to(at(1), 10.0);
    harm(m);
    return from_msg(m).code();
  };
  for (const std::uint32_t polytope : {1u, 4'000'000'000u}) {
    EXPECT_EQ(code([&](auto& m) { m.pieces()[0].polytope(polytope); }), ErrorCode::invalid_input);
  }
  EXPECT_EQ(code([](auto& m) { m.pieces().clear(); }), ErrorCode::invalid_input);
  EXPECT_EQ(code([](auto& m) { m.polytopes()[0].offsets()[0] = kNotANumber; }), ErrorCode::invalid_input);
  EXPECT_EQ(code([](auto& m) { m.polytopes()[0].normals()[0] = 2.0; }), ErrorCode::invalid_input);
  EXPECT_EQ(code([](auto& m) { m.polytopes()[0].offsets().pop_back(); }), ErrorCode::invalid_input);
  EXPECT_EQ(code([](auto& m) { m.request().limits().norm(9); }), ErrorCode::invalid_limits);
  EXPECT_EQ(code([](auto& m) { m.request().limits().v_max(0.0); }), ErrorCode::invalid_limits);
  EXPECT_EQ(code([](auto& m) { m.header().frame_id("odom"); }), ErrorCode::wrong_frame);
  EXPECT_EQ(code([](auto& m) { m.request().header().frame_id("odom"); }), ErrorCode::wrong_frame);
}

TEST(TrajectoryMessage, CarriesACurveOfYawOrNone) {
  auto m = trajectory_to(at(1), 10.0);
  EXPECT_FALSE(yaw_curve_of(m)->has_value());
  const YawCurve in{0.5, {0.0, 1.0, 2.0, 2.5}};
  fill_yaw(in, m);
  const auto out = yaw_curve_of(m);
  ASSERT_TRUE(out.ok() && out->has_value());
  EXPECT_EQ((*out)->step_s, in.step_s);
  EXPECT_EQ((*out)->points_rad, in.points_rad);
  m.yaw_points().resize(2);
  EXPECT_EQ(yaw_curve_of(m).code(), ErrorCode::invalid_input);
}

msg::CommittedTrajectory commit_of(msg::BezierTrajectory nominal) {
  msg::CommittedTrajectory m;
  m.header(make_header(0));
  m.nominal(std::move(nominal));
  return m;
}

// From the nominal part's state after after_s to rest.
StopPart stop_of(const msg::BezierTrajectory& nominal, double after_s) {
  FlatState from = from_msg(nominal)->trajectory().sample(after_s);
  from.jerk.setZero();
  const FlatState to = at(from.position.x() + from.velocity.x());
  Trajectory line{{BezierPiece::between(from, to, 2.0)}};
  return {after_s, certify(std::move(line), kRoom, Limits{.a_max_m_s2 = 2.0}, from, to).value()};
}

TEST(CommitMessage, SurvivesTheRoundTripWithItsStopPart) {
  const auto nominal = trajectory_to(at(1, 0.25), 8.0);  // ends in motion
  auto made = CommittedTrajectory::make({.id = 12,
                                         .nominal = *from_msg(nominal),
                                         .stop = stop_of(nominal, 4.0),
                                         .start_time_ns = 7'000'000'001,
                                         .map_version = 9,
                                         .yaw_rad = 0.5});
  ASSERT_TRUE(made.ok()) << made.error().message;
  auto m = commit_of(nominal);
  fill_msg(*made, m);
  const auto out = from_msg(m);
  ASSERT_TRUE(out.ok()) << out.error().message;
  EXPECT_EQ(out->id(), 12u);
  EXPECT_EQ(out->start_time_ns(), 7'000'000'001);
  EXPECT_EQ(out->map_version(), 9u);
  EXPECT_EQ(out->yaw_rad(), 0.5);
  ASSERT_TRUE(out->stop().has_value());
  EXPECT_EQ(out->stop()->after_s, 4.0);
  EXPECT_EQ(out->stop()->trajectory.polytopes(), kRoom);
  EXPECT_NEAR(out->flown().duration_s(), 6.0, 1e-12);
  EXPECT_LT(largest_difference(out->flown().sample(6.0), made->flown().sample(6.0)), 1e-12);
}

TEST(CommitMessage, WithoutAStopPartEndsAtRest) {
  const auto m = commit_of(trajectory_to(at(1), 10.0));
  const auto committed = from_msg(m);
  ASSERT_TRUE(committed.ok()) << committed.error().message;
  EXPECT_FALSE(committed->stop().has_value());
  EXPECT_EQ(from_msg(commit_of(trajectory_to(at(1, 0.25), 8.0))).code(), ErrorCode::not_certified);
}

TEST(CommitMessage, IsRefusedWithAStopPartThatDoesNotHold) {
  const auto nominal = trajectory_to(at(1, 0.25), 8.0);
  const auto code = [&](auto&& harm) {
    auto m = commit_of(nominal);
    const StopPart stop = stop_of(nominal, 4.0);
    m.stop_after(stop.after_s);
    m.stop_pieces(to_msg(stop.trajectory.trajectory()));
    m.stop_polytopes(to_msg(stop.trajectory.polytopes()));
    harm(m);
    return from_msg(m).code();
  };
  EXPECT_EQ(code([](auto&) {}), ErrorCode::ok);
  EXPECT_EQ(code([](auto& m) { m.stop_after(4.1); }), ErrorCode::not_certified);
  for (const double after_s : {0.0, -1.0, 8.5, kNotANumber}) {
    EXPECT_EQ(code([&](auto& m) { m.stop_after(after_s); }), ErrorCode::invalid_input) << after_s;
  }
  EXPECT_EQ(code([](auto& m) { m.stop_pieces().clear(); }), ErrorCode::invalid_input);
  EXPECT_EQ(code([](auto& m) { m.stop_polytopes().clear(); }), ErrorCode::invalid_input);
  EXPECT_EQ(code([](auto& m) { m.stop_pieces()[0].control_points()[4].x(0.0); }),
            ErrorCode::not_certified)
      << "it does not end at rest";
  EXPECT_EQ(code([](auto& m) { m.stop_pieces()[0].control_points()[3].y(4.0); }),
            ErrorCode::not_certified)
      << "it leaves its polytope";
  EXPECT_EQ(code([](auto& m) { m.stop_polytopes()[0].valid_until(1.5); }), ErrorCode::not_certified)
      << "it outlasts its polytope, counted from its own start";
}

TEST(CommitMessage, IsRefusedInAnotherFrameOrWithABrokenCurve) {
  auto m = commit_of(trajectory_to(at(1), 10.0));
  m.header().frame_id("odom");
  EXPECT_EQ(from_msg(m).code(), ErrorCode::wrong_frame);
  m = commit_of(trajectory_to(at(1), 10.0));
  m.nominal().yaw_points({1.0});
  EXPECT_EQ(from_msg(m).code(), ErrorCode::invalid_input);
  m = commit_of(trajectory_to(at(1), 10.0));
  m.yaw(kNotANumber);
  EXPECT_EQ(from_msg(m).code(), ErrorCode::invalid_input);
}

}  // namespace
}  // namespace goshawk::conversions
