#include "goshawk/tracker/tracker.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "trajectories.hpp"

namespace goshawk::tracker {
namespace {

using testing::HasSubstr;

std::int64_t ns(double s) {
  return std::llround(s * 1e9);
}

Tracker make(const Config& config = {}) {
  return Tracker::create(without_map(config)).value();
}

RigidBodyState at(const Vec3& p, const Vec3& v = Vec3::Zero()) {
  RigidBodyState state;
  state.position_map = p;
  state.velocity_map = v;
  return state;
}

// A vehicle that is always exactly where it should be.
void follow(Tracker& tracker, double from_s, double to_s) {
  for (double t = from_s; t <= to_s; t += 0.01) {
    const auto r = tracker.status().reference;
    ASSERT_TRUE(tracker.step(at(r.position, r.velocity), ns(t)));
  }
}

Draft line(std::uint64_t id, const Vec3& from, const Vec3& to, double start_s,
           double duration_s = 4.0) {
  auto committed = straight_line(from, to, duration_s);
  committed.id = id;
  committed.start_time_ns = ns(start_s);
  return committed;
}

// What remains of `before` after t_s, bent towards another end.
Draft replanned(std::uint64_t id, const Draft& before, double t_s, const Vec3& end) {
  Draft committed;
  committed.id = id;
  committed.trajectory.pieces = {
      BezierPiece::between(before.trajectory.sample(t_s), {.position = end}, 5.0)};
  committed.start_time_ns = before.start_time_ns + ns(t_s);
  certify_as_is(committed);
  return committed;
}

TEST(Tracker, IsIdleBeforeOdometryAndThenHoldsWhereItFirstWas) {
  auto tracker = make();
  EXPECT_EQ(tracker.status().mode, Mode::idle);
  ASSERT_TRUE(tracker.step(at({1, 2, 3}), ns(1.0)));
  ASSERT_TRUE(tracker.step(at({1.04, 2, 3}), ns(1.1)));
  const auto status = tracker.status();
  EXPECT_EQ(status.mode, Mode::hold);
  EXPECT_EQ(status.reference.position, Vec3(1, 2, 3));
  EXPECT_NEAR(status.error_m, 0.04, 1e-12);
  EXPECT_EQ(status.trajectory_id, 0U);
}

TEST(Tracker, FollowsFromTheStartTimeExactlyAndHoldsAtTheEnd) {
  auto tracker = make();
  ASSERT_TRUE(tracker.step(at({0, 0, 1}), 0));
  const auto committed = line(7, {0, 0, 1}, {2, 0, 1}, 1.0);
  ASSERT_TRUE(tracker.accept(committed, ns(0.0)));
  EXPECT_EQ(tracker.status().queued, 1);
  ASSERT_TRUE(tracker.step(at({0, 0, 1}), ns(0.05)));
  for (double t = 0.1; t < 0.99; t += 0.05) ASSERT_TRUE(tracker.step(at({0, 0, 1}), ns(t)));
  ASSERT_TRUE(tracker.step(at({0, 0, 1}), ns(1.0) - 1));
  EXPECT_EQ(tracker.status().mode, Mode::hold);
  ASSERT_TRUE(tracker.step(at({0, 0, 1}), ns(1.0)));
  EXPECT_EQ(tracker.status().mode, Mode::follow);
  EXPECT_EQ(tracker.status().trajectory_id, 7U);
  EXPECT_EQ(tracker.status().queued, 0);
  follow(tracker, 1.01, 6.0);
  const auto status = tracker.status();
  EXPECT_EQ(status.mode, Mode::hold);
  EXPECT_EQ(status.trajectory_id, 7U);
  EXPECT_EQ(status.progress_s, status.duration_s);
  EXPECT_LT((status.reference.position - Vec3(2, 0, 1)).norm(), 1e-9);
  EXPECT_EQ(status.fault.code, ErrorCode::ok);
}

TEST(Tracker, ReplansInFlightAndFollowsTheOldOneUntilThen) {
  auto tracker = make();
  ASSERT_TRUE(tracker.step(at({0, 0, 1}), 0));
  const auto first = line(1, {0, 0, 1}, {4, 0, 1}, 0.0);
  ASSERT_TRUE(tracker.accept(first, 0));
  follow(tracker, 0.01, 1.0);
  ASSERT_TRUE(tracker.accept(replanned(2, first, 1.5, {4, 2, 1}), ns(1.0)));
  follow(tracker, 1.01, 1.49);
  EXPECT_EQ(tracker.status().trajectory_id, 1U);
  follow(tracker, 1.5, 7.0);
  EXPECT_EQ(tracker.status().trajectory_id, 2U);
  EXPECT_LT((tracker.status().reference.position - Vec3(4, 2, 1)).norm(), 1e-9);
  EXPECT_LT(tracker.status().max_error_m, 0.05);  // one step of the fake vehicle's lag
}

TEST(Tracker, ALaterPlanReplacesWhatIsQueuedForTheSameTimeOrAfter) {
  auto tracker = make();
  ASSERT_TRUE(tracker.step(at({0, 0, 1}), 0));
  const auto first = line(1, {0, 0, 1}, {4, 0, 1}, 0.0);
  ASSERT_TRUE(tracker.accept(first, 0));
  follow(tracker, 0.01, 0.5);
  ASSERT_TRUE(tracker.accept(replanned(2, first, 2.0, {4, 2, 1}), ns(0.5)));
  ASSERT_TRUE(tracker.accept(replanned(3, first, 1.5, {4, -2, 1}), ns(0.5)));
  EXPECT_EQ(tracker.status().queued, 1);
  follow(tracker, 0.51, 3.0);
  EXPECT_EQ(tracker.status().trajectory_id, 3U);

  // And one that continues what is queued, not what is flown, waits behind it.
  auto other = make();
  ASSERT_TRUE(other.step(at({0, 0, 1}), 0));
  ASSERT_TRUE(other.accept(first, 0));
  const auto second = replanned(2, first, 1.0, {4, 2, 1});
  ASSERT_TRUE(other.accept(second, 0));
  ASSERT_TRUE(other.accept(replanned(3, second, 1.0, {4, 3, 1}), 0));
  EXPECT_EQ(other.status().queued, 3);
}

// Nobody fills the tracker's memory, or its time with every map.
TEST(Tracker, WhatWaitsIsBounded) {
  auto tracker = make();
  ASSERT_TRUE(tracker.step(at({0, 0, 1}), 0));
  int accepted = 0;
  for (int k = 0; k < 50; ++k) {
    const auto status =
        tracker.accept(line(std::uint64_t(k + 1), {0, 0, 1}, {0.01, 0, 1}, 1.0 + k), 0);
    accepted += int(status.ok());
    EXPECT_THAT(status.code(), testing::AnyOf(ErrorCode::ok, ErrorCode::not_at_start));
  }
  EXPECT_EQ(accepted, 8);
  EXPECT_EQ(tracker.status().queued, 8);
  EXPECT_TRUE(tracker.accept(line(99, {0, 0, 1}, {1, 0, 1}, 0.5), 0)) << "takes the place of all";
  EXPECT_EQ(tracker.status().queued, 1);
  EXPECT_EQ(tracker.accept(line(100, {0, 0, 1}, {1, 0, 1}, 3e8), 0).code(),
            ErrorCode::not_at_start);
}

TEST(Tracker, ATrajectoryThatBeganIsJoinedWhereItShouldBeByNow) {
  auto tracker = make();
  const auto committed = line(1, {0, 0, 1}, {2, 0, 1}, 0.0);
  const auto there = committed.trajectory.sample(1.0);
  ASSERT_TRUE(tracker.step(at(there.position), ns(0.99)));
  ASSERT_TRUE(tracker.step(at(there.position, there.velocity), ns(1.0)));
  ASSERT_TRUE(tracker.accept(committed, ns(1.0)));
  ASSERT_TRUE(tracker.step(at(there.position, there.velocity), ns(1.0)));
  EXPECT_EQ(tracker.status().mode, Mode::follow);
  EXPECT_LT(tracker.status().error_m, 1e-9);
}

TEST(Tracker, RefusesWhatDoesNotStartWhereTheVehicleIsAndFliesOn) {
  auto tracker = make();
  const auto flown = line(1, {0, 0, 1}, {4, 0, 1}, 0.0);
  EXPECT_EQ(tracker.accept(flown, 0).code(), ErrorCode::not_at_start);  // no odometry yet
  ASSERT_TRUE(tracker.step(at({0, 0, 1}), 0));
  ASSERT_TRUE(tracker.accept(flown, 0));
  follow(tracker, 0.01, 1.0);

  const auto refused = [&](Draft committed, ErrorCode code, const char* sentence) {
    const auto status = tracker.accept(std::move(committed), ns(1.0));
    EXPECT_EQ(status.code(), code);
    if (!status) {
      EXPECT_THAT(status.error().message, HasSubstr(sentence));
    }
  };
  refused(line(2, {0, 1, 1}, {4, 0, 1}, 1.0), ErrorCode::not_at_start, "plan from there");
  refused(line(3, {3, 0, 1}, {4, 0, 1}, 2.0), ErrorCode::not_at_start, "trajectory 3");
  // At the right place, but at rest where the vehicle will fly at 2 m/s.
  refused(line(4, flown.trajectory.sample(2.0).position, {4, 0, 1}, 2.0), ErrorCode::not_at_start,
          "m/s");
  refused(line(5, {0, 0, 1}, {4, 0, 1}, -10.0), ErrorCode::deadline_exceeded, "ended 7 s ago");
  auto no_clock = replanned(7, flown, 1.5, {4, 1, 1});
  EXPECT_EQ(tracker.accept(no_clock, std::numeric_limits<std::int64_t>::max()).code(),
            ErrorCode::invalid_input);

  EXPECT_EQ(tracker.status().queued, 0);
  follow(tracker, 1.01, 5.0);
  EXPECT_EQ(tracker.status().trajectory_id, 1U);
  EXPECT_EQ(tracker.status().fault.code, ErrorCode::ok);
}

TEST(Tracker, TheStartToleranceIsAsConfigured) {
  Config config;
  config.start_tolerance_m = 0.05;
  for (const double offset : {0.04, 0.06}) {
    auto tracker = make(config);
    ASSERT_TRUE(tracker.step(at({0, 0, 1}), 0));
    EXPECT_EQ(bool(tracker.accept(line(1, {offset, 0, 1}, {2, 0, 1}, 0.5), 0)), offset < 0.05);
  }
}

TEST(Tracker, BadOdometryGivesAnErrorAndNeverACommand) {
  auto tracker = make();
  ASSERT_TRUE(tracker.step(at({0, 0, 1}), ns(10.0)));
  const double nan = std::nan("");
  const auto bad = [&](RigidBodyState state) { return tracker.step(state, ns(10.01)).code(); };
  EXPECT_EQ(bad(at({nan, 0, 1})), ErrorCode::invalid_input);
  EXPECT_EQ(bad(at({0, 0, 1}, {0, HUGE_VAL, 0})), ErrorCode::invalid_input);
  auto state = at({0, 0, 1});
  state.q_map_base.coeffs().setZero();
  EXPECT_EQ(bad(state), ErrorCode::invalid_input);
  state = at({0, 0, 1});
  state.angular_velocity_base.x() = nan;
  EXPECT_EQ(bad(state), ErrorCode::invalid_input);
  EXPECT_EQ(tracker.status().fault.code, ErrorCode::invalid_input);

  state = at({0, 0, 1});
  EXPECT_EQ(tracker.step(state, ns(10.0), ns(10.2)).code(), ErrorCode::tracking_lost);  // stale
  EXPECT_EQ(tracker.step(state, ns(10.5), ns(10.2)).code(), ErrorCode::invalid_input);  // future
  EXPECT_EQ(tracker.step(state, ns(9.95), ns(10.0)).code(), ErrorCode::invalid_input);  // older
  EXPECT_EQ(tracker.step(state, std::numeric_limits<std::int64_t>::min(), 0).code(),
            ErrorCode::invalid_input);
  ASSERT_TRUE(tracker.step(state, ns(10.25)));
  ASSERT_TRUE(tracker.step(state, ns(10.30)));
  EXPECT_EQ(tracker.status().fault.code, ErrorCode::process_stalled);  // from 10.01 to 10.2
  for (double t = 10.35; t < 11.4; t += 0.05) ASSERT_TRUE(tracker.step(state, ns(t)));
  EXPECT_EQ(tracker.status().fault.code, ErrorCode::ok);
}

TEST(Tracker, AfterAPauseOfItsOwnItTakesNothingUntilItKnowsWhereTheVehicleIs) {
  auto tracker = make();
  ASSERT_TRUE(tracker.step(at({0, 0, 1}), 0));
  const auto first = line(1, {0, 0, 1}, {4, 0, 1}, 0.0);
  ASSERT_TRUE(tracker.accept(first, 0));
  follow(tracker, 0.01, 1.0);
  ASSERT_TRUE(tracker.accept(replanned(2, first, 1.5, {4, 2, 1}), ns(1.0)));
  tracker.watch(ns(1.6));  // the second one's time has come meanwhile
  EXPECT_EQ(tracker.status().fault.code, ErrorCode::process_stalled);
  EXPECT_EQ(tracker.status().lost_trajectory_id, 2U);
  EXPECT_EQ(tracker.status().queued, 0);
  const auto status = tracker.accept(replanned(3, first, 1.6, {4, 2, 1}), ns(1.6));
  EXPECT_EQ(status.code(), ErrorCode::not_at_start);
  // It braked by itself meanwhile: it is held there, not sent to where it should have been.
  const Vec3 here(1.3, 0, 1);
  ASSERT_TRUE(tracker.step(at(here), ns(1.61)));
  for (double t = 1.62; t < 3.0; t += 0.01) ASSERT_TRUE(tracker.step(at(here), ns(t)));
  EXPECT_EQ(tracker.status().mode, Mode::hold);
  EXPECT_LT((tracker.status().reference.position - here).norm(), 0.005);
}

TEST(Tracker, TooLargeAnErrorStopsTheReferenceOnItsPathAndIsReported) {
  auto tracker = make();
  ASSERT_TRUE(tracker.step(at({0, 0, 1}), 0));
  ASSERT_TRUE(tracker.accept(line(1, {0, 0, 1}, {6, 0, 1}, 0.0, 6.0), 0));
  follow(tracker, 0.01, 2.0);
  // The vehicle no longer follows: it is held back by something.
  const Vec3 stuck = tracker.status().reference.position;
  for (double t = 2.01; t < 5.0; t += 0.01) ASSERT_TRUE(tracker.step(at(stuck), ns(t)));
  const auto status = tracker.status();
  EXPECT_EQ(status.mode, Mode::hold);
  EXPECT_EQ(status.fault.code, ErrorCode::tracking_lost);
  EXPECT_THAT(status.fault.message, HasSubstr("m from where it should be"));
  EXPECT_LT(status.progress_s, 4.0);
  EXPECT_NEAR(status.reference.position.y(), 0.0, 1e-12);

  // A new trajectory from where the vehicle is ends it.
  ASSERT_TRUE(tracker.accept(line(2, stuck, {6, 1, 1}, 5.1), ns(5.0)));
  ASSERT_TRUE(tracker.step(at(stuck), ns(5.1)));
  EXPECT_EQ(tracker.status().fault.code, ErrorCode::ok);
  EXPECT_EQ(tracker.status().mode, Mode::follow);
}

TEST(Tracker, BrakesOnDemandAndDropsWhatIsQueued) {
  auto tracker = make();
  ASSERT_TRUE(tracker.step(at({0, 0, 1}), 0));
  const auto first = line(1, {0, 0, 1}, {4, 0, 1}, 0.0);
  ASSERT_TRUE(tracker.accept(first, 0));
  follow(tracker, 0.01, 1.0);
  ASSERT_TRUE(tracker.accept(replanned(2, first, 1.5, {4, 2, 1}), ns(1.0)));
  tracker.brake(ns(1.0));
  follow(tracker, 1.01, 1.1);
  EXPECT_EQ(tracker.status().mode, Mode::brake);
  EXPECT_EQ(tracker.status().queued, 0);
  follow(tracker, 1.11, 4.0);
  EXPECT_EQ(tracker.status().mode, Mode::hold);
  EXPECT_EQ(tracker.status().fault.code, ErrorCode::ok);
}

TEST(Tracker, OdometryThatJumpsIsReportedAndTheVehicleStaysWhereItIs) {
  auto tracker = make();
  ASSERT_TRUE(tracker.step(at({0, 0, 1}), 0));
  ASSERT_TRUE(tracker.accept(line(1, {0, 0, 1}, {4, 0, 1}, 0.0), 0));
  follow(tracker, 0.01, 0.5);
  const auto command = tracker.step(at({5, 5, 1}), ns(0.51));
  ASSERT_TRUE(command);
  EXPECT_NEAR(command->thrust_n, kGravity_m_s2, 0.1);  // no rush to another place
  EXPECT_EQ(tracker.status().mode, Mode::hold);
  EXPECT_EQ(tracker.status().fault.code, ErrorCode::tracking_lost);
  EXPECT_THAT(tracker.status().fault.message, HasSubstr("jumped"));
}

TEST(Tracker, ARestartedClockBeginsAnew) {
  auto tracker = make();
  ASSERT_TRUE(tracker.step(at({0, 0, 1}), ns(100.0)));
  ASSERT_TRUE(tracker.accept(line(1, {0, 0, 1}, {4, 0, 1}, 101.0), ns(100.0)));
  ASSERT_TRUE(tracker.step(at({3, 3, 1}), ns(0.0)));
  EXPECT_EQ(tracker.status().mode, Mode::hold);
  EXPECT_EQ(tracker.status().queued, 0);
  EXPECT_EQ(tracker.status().reference.position, Vec3(3, 3, 1));
  EXPECT_EQ(tracker.status().fault.code, ErrorCode::ok);
}

double yaw_after(const Config& config, double wanted, double duration_s) {
  auto tracker = make(config);
  EXPECT_TRUE(tracker.step(at({0, 0, 1}), 0));
  auto committed = line(1, {0, 0, 1}, {2, 0, 1}, 0.0);
  committed.yaw_rad = wanted;
  EXPECT_TRUE(tracker.accept(committed, 0));
  double yaw = 0.0;
  for (double t = 0.01; t <= duration_s; t += 0.01) {
    const auto r = tracker.status().reference;
    const auto command = tracker.step(at(r.position, r.velocity), ns(t));
    const Vec3 x = command->q_map_base * Vec3::UnitX();
    yaw = std::atan2(x.y(), x.x());
  }
  return yaw;
}

TEST(Tracker, TurnsToThePlansYawAtABoundedRateOrKeepsItsOwn) {
  Config config;
  EXPECT_NEAR(yaw_after(config, 2.0, 1.0), 1.0, 0.011);
  EXPECT_NEAR(yaw_after(config, 2.0, 3.0), 2.0, 1e-9);
  EXPECT_NEAR(yaw_after(config, -3.0, 1.0), -1.0, 0.011);
  config.yaw = "keep";
  EXPECT_NEAR(yaw_after(config, 2.0, 3.0), 0.0, 1e-9);
}

// A curve that turns by 0.8 rad/s for two seconds, and then holds.
Draft turning_line(double start_yaw) {
  auto committed = line(1, {0, 0, 1}, {2, 0, 1}, 0.0);
  committed.yaw_curve = YawCurve{.step_s = 0.1, .points_rad = {}};
  for (int k = -1; k <= 40; ++k) {
    const double t = std::clamp(0.1 * k, 0.0, 2.0);
    committed.yaw_curve->points_rad.push_back(start_yaw + 0.8 * t);
  }
  return committed;
}

TEST(Tracker, FollowsACurveOfYawWithinItsRate) {
  for (const double start_yaw : {0.0, 0.5}) {
    Config config;
    auto tracker = make(config);
    ASSERT_TRUE(tracker.step(at({0, 0, 1}), 0));
    const auto committed = turning_line(start_yaw);
    ASSERT_TRUE(tracker.accept(committed, 0));
    double last = 0.0;
    for (double t = 0.01; t <= 4.0; t += 0.01) {
      const auto r = tracker.status().reference;
      const auto command = tracker.step(at(r.position, r.velocity), ns(t));
      ASSERT_TRUE(command);
      const Vec3 x = command->q_map_base * Vec3::UnitX();
      const double yaw = std::atan2(x.y(), x.x());
      EXPECT_LE(std::abs(yaw - last), config.max_yaw_rate_rad_s * 0.01 + 1e-3);
      // It begins elsewhere than the vehicle looks: caught up with by what the rate leaves.
      const bool caught_up = t > start_yaw / (config.max_yaw_rate_rad_s - 0.8) + 0.1;
      if (caught_up) {
        EXPECT_NEAR(yaw, committed.yaw_curve->yaw_rad(t), 1e-6) << t;
      }
      last = yaw;
    }
    EXPECT_NEAR(last, start_yaw + 1.6, 1e-6);
  }
}

}  // namespace
}  // namespace goshawk::tracker
