#include "goshawk/core/committed_trajectory.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "goshawk/core/random.hpp"

namespace goshawk {
namespace {

const std::vector<Polytope> kRoom{Polytope::box(Vec3::Constant(-9), Vec3::Constant(9))};

CertifiedTrajectory certified(const FlatState& from, const FlatState& to, double duration_s) {
  Trajectory trajectory{{BezierPiece::between(from, to, duration_s)}};
  return certify(std::move(trajectory), kRoom, Limits{.v_max_m_s = 5.0, .a_max_m_s2 = 50.0}, from,
                 to)
      .value();
}

FlatState at(double x, double v = 0.0) {
  FlatState state;
  state.position.x() = x;
  state.velocity.x() = v;
  return state;
}

// To rest within a second, from where the nominal part is after after_s.
StopPart stop_of(const CertifiedTrajectory& nominal, double after_s) {
  FlatState from = nominal.trajectory().sample(after_s);
  from.jerk.setZero();
  FlatState to;
  to.position = from.position + 0.5 * from.velocity;
  return {after_s, certified(from, to, 1.0)};
}

TEST(CommittedTrajectory, WithoutAStopPartFliesTheNominalPart) {
  Commitment content{.id = 3, .nominal = certified(at(0), at(2), 4.0), .start_time_ns = 17};
  content.map_version = 8;
  content.yaw_rad = 0.5;
  const auto committed = CommittedTrajectory::make(std::move(content));
  ASSERT_TRUE(committed.ok()) << committed.error().message;
  EXPECT_EQ(committed->id(), 3u);
  EXPECT_EQ(committed->start_time_ns(), 17);
  EXPECT_EQ(committed->map_version(), 8u);
  EXPECT_FALSE(committed->stop().has_value());
  EXPECT_EQ(&committed->flown(), &committed->nominal().trajectory());
  EXPECT_EQ(committed->flown_polytopes(), kRoom);
  EXPECT_EQ(committed->yaw_at(1.0), 0.5);
}

TEST(CommittedTrajectory, WithAStopPartFliesTheNominalPartUntilItBegins) {
  const auto nominal = certified(at(0), at(4, 1.0), 4.0);
  ASSERT_FALSE(nominal.ends_at_rest());
  const auto committed =
      CommittedTrajectory::make({.id = 1, .nominal = nominal, .stop = stop_of(nominal, 1.5)});
  ASSERT_TRUE(committed.ok()) << committed.error().message;
  const Trajectory& flown = committed->flown();
  EXPECT_NEAR(flown.duration_s(), 2.5, 1e-12);
  for (double t = 0.0; t <= 1.5; t += 0.1) {
    EXPECT_LT(largest_difference(flown.sample(t), nominal.trajectory().sample(t)), 1e-12) << t;
  }
  for (double t = 1.51; t <= 2.5; t += 0.1) {
    const auto stop = committed->stop()->trajectory.trajectory().sample(t - 1.5);
    EXPECT_LT(largest_difference(flown.sample(t), stop), 1e-12) << t;
  }
  ASSERT_EQ(flown.pieces.size(), 2u);
  EXPECT_EQ(flown.pieces[0].polytope, 0);
  EXPECT_EQ(flown.pieces[1].polytope, 1) << "after the nominal part's polytopes";
  EXPECT_EQ(committed->flown_polytopes(), (std::vector{kRoom[0], kRoom[0]}));
}

TEST(CommittedTrajectory, MustEndAtRest) {
  const auto moving = certified(at(0), at(4, 1.0), 4.0);
  const auto nominal = CommittedTrajectory::make({.id = 5, .nominal = moving});
  ASSERT_EQ(nominal.code(), ErrorCode::not_certified);
  EXPECT_NE(nominal.error().message.find("trajectory 5 refused: it does not end at rest"),
            std::string::npos)
      << nominal.error().message;
  const FlatState from = moving.trajectory().sample(2.0);
  const StopPart goes_on{2.0, certified(from, at(6, 1.0), 3.0)};
  EXPECT_EQ(CommittedTrajectory::make({.nominal = moving, .stop = goes_on}).code(),
            ErrorCode::not_certified);
}

TEST(CommittedTrajectory, MustPassFromTheNominalToTheStopPartWithoutAJump) {
  const auto nominal = certified(at(0), at(4), 4.0);
  StopPart stop = stop_of(nominal, 1.5);
  for (const double after_s : {1.4999, 1.51, 3.0}) {
    stop.after_s = after_s;
    EXPECT_EQ(CommittedTrajectory::make({.nominal = nominal, .stop = stop}).code(),
              ErrorCode::not_certified)
        << after_s;
  }
  for (const double after_s : {0.0, -1.0, 4.5, double(NAN)}) {
    stop.after_s = after_s;
    EXPECT_EQ(CommittedTrajectory::make({.nominal = nominal, .stop = stop}).code(),
              ErrorCode::invalid_input)
        << after_s;
  }
}

TEST(CommittedTrajectory, TurnsByItsYawCurve) {
  const auto nominal = certified(at(0), at(2), 4.0);
  const auto committed = CommittedTrajectory::make(
      {.nominal = nominal, .yaw_rad = 9.0, .yaw_curve = YawCurve{4.0, {0.0, 2.0, 4.0}}});
  ASSERT_TRUE(committed.ok());
  EXPECT_DOUBLE_EQ(committed->yaw_at(0.0), 1.0);
  EXPECT_DOUBLE_EQ(committed->yaw_at(2.0), 2.0);
  EXPECT_DOUBLE_EQ(committed->yaw_at(99.0), 3.0);
}

TEST(CommittedTrajectory, IsRefusedWithYawOrTimeOutOfRange) {
  const auto nominal = certified(at(0), at(2), 4.0);
  const auto code = [&](auto&& harm) {
    Commitment content{.nominal = nominal};
    harm(content);
    return CommittedTrajectory::make(std::move(content)).code();
  };
  EXPECT_EQ(code([](Commitment&) {}), ErrorCode::ok);
  EXPECT_EQ(code([](Commitment& c) { c.yaw_rad = NAN; }), ErrorCode::invalid_input);
  EXPECT_EQ(code([](Commitment& c) { c.yaw_curve = YawCurve{}; }), ErrorCode::invalid_input);
  EXPECT_EQ(code([](Commitment& c) { c.start_time_ns = std::numeric_limits<std::int64_t>::min(); }),
            ErrorCode::invalid_input);
}

/// Three pieces, each in a room of its own that is free only while the piece is flown, and a
/// little longer.
CertifiedTrajectory through_timed_rooms(Random& random, const FlatState& from, bool to_rest) {
  Trajectory trajectory;
  std::vector<Polytope> rooms;
  FlatState state = from;
  double begin_s = 0.0;
  for (int k = 0; k < 3; ++k) {
    FlatState next;
    next.position = state.position + Vec3(1.0, random.uniform(-0.3, 0.3), 0.0);
    if (k < 2 || !to_rest) next.velocity = Vec3(0.8, random.uniform(-0.2, 0.2), 0.0);
    trajectory.pieces.push_back(BezierPiece::between(state, next, random.uniform(1.0, 1.6)));
    trajectory.pieces.back().polytope = k;
    rooms.push_back(
        Polytope::box(state.position - Vec3::Constant(2.0), next.position + Vec3::Constant(2.0)));
    rooms.back().valid_from_s = begin_s - 0.01;
    begin_s += trajectory.pieces.back().duration_s;
    rooms.back().valid_until_s = begin_s + 0.01;
    state = next;
  }
  return certify(trajectory, rooms, Limits{.v_max_m_s = 5.0, .a_max_m_s2 = 50.0}, from, state)
      .value();
}

// The parts are certified apart, each with times from its own start: the whole is as good.
TEST(CommittedTrajectory, WhatIsFlownIsCertifiedAsAWholeWithTheTimesOfItsRooms) {
  Random random(1);
  for (int n = 0; n < 50; ++n) {
    const auto nominal = through_timed_rooms(random, at(0), false);
    const double after_s = random.uniform(0.1, 0.95) * nominal.duration_s();
    FlatState turn = nominal.trajectory().sample(after_s);
    turn.jerk.setZero();
    const auto stop = through_timed_rooms(random, turn, true);
    const auto committed =
        CommittedTrajectory::make({.nominal = nominal, .stop = StopPart{after_s, stop}});
    ASSERT_TRUE(committed) << committed.error().message;
    auto rooms = committed->flown_polytopes();
    const auto certificate = [&] {
      return measure(committed->flown(), rooms, nominal.limits(), nominal.start(), stop.goal());
    };
    ASSERT_TRUE(certificate().holds()) << certificate().worst();
    ASSERT_NEAR(committed->flown().duration_s(), after_s + stop.duration_s(), 1e-9);
    // And no better: a room of the stop part that closes sooner is noticed.
    rooms[std::size_t(3 + random.below(3))].valid_until_s -= 0.02;
    ASSERT_NEAR(certificate().validity_s, 0.01, 1e-9);
    ASSERT_FALSE(certificate().holds());
  }
}

}  // namespace
}  // namespace goshawk
