#include "goshawk/guard/guard.hpp"

#include <cmath>

#include "goshawk/core/random.hpp"
#include "harness.hpp"

namespace goshawk::guard {
namespace {

using testing::HasSubstr;
const Vec3 kFar(18.1, 0.1, 2.1);

TEST(Passing, ASplineThatIsSafeIsFlownAsItIs) {
  Harness h;
  const auto decision = h.send(straight_plan(kHome, kFar, 16.0));
  EXPECT_EQ(decision.verdict, Verdict::passed) << decision.reason.message;
  EXPECT_FALSE(decision.trimmed);
  EXPECT_EQ(decision.reason.code, ErrorCode::ok);
  EXPECT_EQ(decision.deviation_m, 0.0);
  ASSERT_EQ(h.commits.size(), 1u);
  EXPECT_EQ(decision.commit_id, h.last().id());
  EXPECT_FALSE(h.last().stop());
  EXPECT_EQ(h.last().start_time_ns(), h.now + kSecond / 20);
  EXPECT_EQ(h.last().map_version(), 7u);
  EXPECT_EQ(h.last().yaw_rad(), kYaw_rad);
  EXPECT_NEAR(h.last().nominal().duration_s(), 16.0, 1e-9);
  expect_safe(h, h.last());
}

TEST(Passing, TheSameCurveGoesOnIfItIsSentAgain) {
  Harness h;
  const Plan plan = straight_plan(kHome, kFar, 16.0, h.now);
  h.send(plan);
  const double behind_s = 0.05;  // a commit begins this long after the plan's own start
  h.pass(4.0);
  Plan again = plan;
  *again.start_time_ns += std::int64_t(behind_s * 1e9);
  const auto decision = h.send(again);
  EXPECT_EQ(decision.verdict, Verdict::passed) << decision.reason.message;
  expect_safe(h, h.last());
  EXPECT_NEAR(h.last().nominal().duration_s(), 16.0 - 4.0, 1e-3);
}

TEST(Passing, APlanWithAStartAheadIsJoinedThen) {
  Harness h;
  h.send(straight_plan(kHome, kFar, 16.0));
  const std::int64_t at = h.now + kSecond;
  const FlatState then = h.ahead(1.0);
  const FlatState end{.position = kFar};
  const BezierPiece piece = BezierPiece::between(then, end, 20.0);
  Samples samples;
  for (int i = 0; i <= 40; ++i) {
    const FlatState s = piece.sample(0.5 * i);
    samples.samples.push_back({0.5 * i, s.position, s.velocity, s.acceleration});
  }
  const auto decision =
      h.send({.kind = PlanKind::trajectory, .start_time_ns = at, .shape = samples});
  EXPECT_EQ(decision.verdict, Verdict::passed) << decision.reason.message;
  EXPECT_EQ(h.last().start_time_ns(), at);
  expect_safe(h, h.last());
}

TEST(Passing, APathWithoutTimesIsFlownAsFastAsTheLimitsAllowAndStaysNear) {
  Harness h;
  const std::vector<Vec3> points{kHome, {5.1, 0.1, 2.1}, {5.1, 3.1, 2.1}, {12.1, 3.1, 2.1}};
  const auto decision = h.send(path_plan(points));
  EXPECT_EQ(decision.verdict, Verdict::passed) << decision.reason.message;
  EXPECT_FALSE(decision.trimmed);
  EXPECT_LE(decision.deviation_m, 1.3 * Config{}.follow_within_m) << "a bound of it";
  expect_safe(h, h.last());
  const Trajectory& flown = h.last().flown();
  EXPECT_LT((flown.sample(flown.duration_s()).position - points.back()).norm(), 1e-6);
  EXPECT_LT(flown.duration_s(), 14.0);
  for (int i = 0; i <= 300; ++i) {
    const Vec3 p = flown.sample(flown.duration_s() * i / 300).position;
    double least = HUGE_VAL;
    for (std::size_t k = 0; k + 1 < points.size(); ++k) {
      const Vec3 along = points[k + 1] - points[k];
      const double share = std::clamp((p - points[k]).dot(along) / along.squaredNorm(), 0.0, 1.0);
      least = std::min(least, (p - points[k] - share * along).norm());
    }
    EXPECT_LE(least, decision.deviation_m + 1e-9);
  }
}

TEST(Slowing, ACurveThatIsTooFastIsFlownSlowerFromRest) {
  Harness h;
  const auto decision = h.send(straight_plan(kHome, kFar, 3.0));
  EXPECT_EQ(decision.verdict, Verdict::slowed) << decision.reason.message;
  EXPECT_EQ(decision.reason.code, ErrorCode::trajectory_infeasible);
  EXPECT_THAT(decision.reason.message, HasSubstr("times slower"));
  EXPECT_TRUE(decision.place_map);
  expect_safe(h, h.last());
  for (int i = 0; i <= 100; ++i) {
    const Vec3 p = h.last().flown().sample(h.last().flown().duration_s() * i / 100).position;
    EXPECT_LT(std::abs(p.y() - 0.1) + std::abs(p.z() - 2.1), 1e-9) << "the same line";
  }
}

TEST(Slowing, InFlightItIsReplacedAlongTheSameCurve) {
  Harness h;
  h.send(straight_plan(kHome, kFar, 16.0));
  h.pass(4.0);
  const auto decision = h.send(straight_plan(h.place(), kFar, 4.0));
  EXPECT_EQ(decision.verdict, Verdict::replaced) << decision.reason.message;
  expect_safe(h, h.last());
  const Trajectory& flown = h.last().flown();
  EXPECT_LT((flown.sample(flown.duration_s()).position - kFar).norm(), 1e-3);
}

TEST(Trimming, BeforeAWallThePlanEndsWithAStopThatIsNamed) {
  Harness h({.wall_x_m = 10.0});
  const auto decision = h.send(straight_plan(kHome, kFar, 16.0));
  EXPECT_EQ(decision.verdict, Verdict::passed);
  EXPECT_TRUE(decision.trimmed);
  EXPECT_EQ(decision.reason.code, ErrorCode::trajectory_blocked);
  EXPECT_THAT(decision.reason.message, HasSubstr("map 7 has an obstacle at"));
  ASSERT_TRUE(decision.place_map);
  EXPECT_NEAR(decision.place_map->x(), 9.7, 0.2);
  ASSERT_TRUE(h.last().stop());
  expect_safe(h, h.last());
  const Trajectory& flown = h.last().flown();
  EXPECT_NEAR(flown.sample(flown.duration_s()).position.x(), 9.6, 0.3) << "as late as it may";
}

TEST(Trimming, ThePathEndsBeforeTheWall) {
  Harness h({.wall_x_m = 10.0});
  const auto decision = h.send(path_plan({kHome, kFar}));
  EXPECT_TRUE(decision.trimmed);
  EXPECT_EQ(decision.reason.code, ErrorCode::trajectory_blocked);
  expect_safe(h, h.last());
  const Trajectory& flown = h.last().flown();
  EXPECT_NEAR(flown.sample(flown.duration_s()).position.x(), 9.6, 0.3);
}

TEST(Trimming, UnseenSpaceIsNotFlownThroughAndTheStopMovesWithTheMap) {
  Harness h({.seen_until_x_m = 8.0, .version = 1});
  const auto decision = h.send(straight_plan(kHome, kFar, 16.0));
  EXPECT_TRUE(decision.trimmed);
  EXPECT_THAT(decision.reason.message, HasSubstr("never seen"));
  expect_safe(h, h.last());
  const double first_s = h.last().stop()->after_s;
  h.pass(1.0);
  h.map({.seen_until_x_m = 12.0, .version = 2});
  ASSERT_EQ(h.commits.size(), 2u);
  ASSERT_TRUE(h.last().stop());
  EXPECT_GT(h.last().stop()->after_s, first_s + 1.0);
  expect_safe(h, h.last());
  h.map({.version = 3});
  ASSERT_EQ(h.commits.size(), 3u);
  EXPECT_FALSE(h.last().stop());
  EXPECT_EQ(h.last().map_version(), 3u);
  h.map({.version = 4});
  EXPECT_EQ(h.commits.size(), 3u) << "there is nothing left to gain";
}

TEST(Trimming, APlanThatDoesNotEndAtRestGetsAStop) {
  Harness h;
  Polynomials line{{{.duration_s = 2.0, .coefficients = {{{1.1, 0, 0, 0.4, -0.1}, {0.1}, {2.1}}}}}};
  const auto decision = h.send({.kind = PlanKind::polynomial, .shape = line});
  EXPECT_EQ(decision.verdict, Verdict::passed) << decision.reason.message;
  EXPECT_TRUE(decision.trimmed);
  ASSERT_TRUE(h.last().stop());
  expect_safe(h, h.last());
}

TEST(Replacing, APlanThatBeginsBesideTheVehicleIsJoined) {
  Harness h;
  const Vec3 beside = kHome + Vec3(0.1, 0.3, 0);
  const auto decision = h.send(straight_plan(beside, kFar, 20.0));
  EXPECT_EQ(decision.verdict, Verdict::replaced) << decision.reason.message;
  EXPECT_EQ(decision.reason.code, ErrorCode::not_at_start);
  expect_safe(h, h.last());
  EXPECT_LT((h.last().flown().sample(0.0).position - kHome).norm(), 1e-6);
}

TEST(Replacing, InFlightTheVehicleStaysInTheStateThatItHas) {
  Random random(1);
  Harness h;
  h.send(straight_plan(kHome, kFar, 16.0));
  int flown = 0;
  for (int i = 0; i < 20; ++i) {
    h.pass(0.3);
    const FlatState then = h.ahead(0.05);
    const Vec3 off(0, random.uniform(-0.2, 0.2), random.uniform(-0.1, 0.1));
    const auto decision = h.send(straight_plan(h.place() + off, kFar + off, 16.0 - 0.3 * i));
    if (decision.commit_id == 0) continue;
    ++flown;
    EXPECT_LT(largest_difference(h.last().flown().sample(0.0), then), 1e-5);
    expect_safe(h, h.last());
  }
  EXPECT_GT(flown, 10);
}

TEST(Refusing, WithoutRepairOnlyWhatIsSafeAsItIsIsFlown) {
  Harness h({}, {.repair = false});
  EXPECT_EQ(h.send(straight_plan(kHome, kFar, 3.0)).verdict, Verdict::refused);
  EXPECT_EQ(h.send(straight_plan(kHome, kFar, 16.0)).verdict, Verdict::passed);
}

TEST(Refusing, WhatIsRefusedChangesNothing) {
  Harness h;
  h.send(straight_plan(kHome, kFar, 16.0));
  h.pass(2.0);
  const auto decision = h.send(straight_plan({5, 4, 2}, {9, 4, 2}, 8.0));
  EXPECT_EQ(decision.verdict, Verdict::refused);
  EXPECT_EQ(decision.reason.code, ErrorCode::not_at_start);
  EXPECT_TRUE(decision.place_map);
  EXPECT_EQ(h.commits.size(), 1u);
  EXPECT_EQ(h.guard.flown().newest(h.now)->id(), h.last().id());
}

TEST(Obstacles, ThatAppearOnTheWayAreBrakedForByTheTrackerAndJoinedAfterwards) {
  Harness h;
  h.send(straight_plan(kHome, kFar, 16.0));
  h.pass(3.0);
  const Vec3 rest = h.place() + Vec3(0.5, 0, 0);
  h.map({.wall_x_m = 12.0, .version = 8});
  const auto early = h.send(straight_plan(h.grid->geometry.center({20, 25, 10}), kFar, 16.0));
  EXPECT_EQ(early.verdict, Verdict::refused);
  EXPECT_EQ(early.reason.code, ErrorCode::not_at_start);
  h.guard.on_tracking({Tracking::Mode::brakes, rest}, h.now);
  h.guard.on_tracking({Tracking::Mode::holds, rest}, h.now);
  const auto decision = h.send(straight_plan(rest, kFar, 16.0));
  EXPECT_TRUE(decision.trimmed);
  expect_safe(h, h.last());
}

TEST(Obstacles, OnWhatANewerPlanReplacesDoNotCount) {
  Harness h;
  h.send(straight_plan(kHome, kFar, 16.0));
  h.pass(3.0);
  const FlatState then = h.ahead(1.0);
  const FlatState end{.position = then.position + Vec3(2, 0, 0)};
  const BezierPiece piece = BezierPiece::between(then, end, 4.0);
  Samples samples;
  for (int i = 0; i <= 8; ++i) {
    const FlatState s = piece.sample(0.5 * i);
    samples.samples.push_back({0.5 * i, s.position, s.velocity, s.acceleration});
  }
  const auto shorter =
      h.send({.kind = PlanKind::trajectory, .start_time_ns = h.now + kSecond, .shape = samples});
  ASSERT_EQ(shorter.verdict, Verdict::passed) << shorter.reason.message;
  h.map({.wall_x_m = end.position.x() + 2.0, .version = 8});  // beyond the end of the newer one
  EXPECT_TRUE(h.guard.flown().at(h.now)) << "before the newer one begins";
  h.pass(2.0);
  h.map({.wall_x_m = end.position.x() + 2.0, .version = 9});
  EXPECT_TRUE(h.guard.flown().at(h.now)) << "while it is flown";
  h.map({.wall_x_m = h.place().x() + 0.6, .version = 10});
  EXPECT_FALSE(h.guard.flown().at(h.now)) << "on what is flown they do";
}

TEST(Silence, OfTheTrackerEndsAllPlansUntilItSpeaksAgain) {
  Harness h;
  h.send(straight_plan(kHome, kFar, 16.0));
  h.pass(2.0);
  for (int i = 0; i < 100; ++i) {  // without a word of the tracker
    h.now += kSecond / 10;
    h.guard.on_plan(straight_plan(h.place(), kFar, 16.0), h.now);
  }
  const auto commits = h.guard.take_commits();
  EXPECT_LE(commits.size(), 20u) << "none later than 2 s";
  const auto refused = h.guard.on_plan(straight_plan(h.place(), kFar, 16.0), h.now);
  EXPECT_EQ(refused.verdict, Verdict::refused);
  EXPECT_EQ(refused.reason.code, ErrorCode::stage_silent);
  const Vec3 rest(4.1, 0.1, 2.1);
  h.guard.on_tracking({Tracking::Mode::holds, rest}, h.now);
  EXPECT_EQ(h.send(straight_plan(rest, kFar, 16.0)).verdict, Verdict::passed);
  EXPECT_LT((h.last().flown().sample(0.0).position - rest).norm(), 1e-6);
}

TEST(Silence, OfAPlannerThatRepeatsItselfIsToldOnce) {
  Harness h;
  h.send(straight_plan(kHome, kFar, 30.0));
  h.pass(5.0);
  EXPECT_FALSE(h.guard.check_silence(h.now)) << "it may plan once and for all";
  const Plan again = straight_plan(h.place(), kFar, 30.0);
  h.send(again);
  h.send(again);
  h.pass(1.0);
  EXPECT_FALSE(h.guard.check_silence(h.now));
  h.pass(1.5);
  const auto silence = h.guard.check_silence(h.now);
  ASSERT_TRUE(silence);
  EXPECT_EQ(silence->code, ErrorCode::stage_silent);
  EXPECT_FALSE(h.guard.check_silence(h.now));
}

// Whatever is sent: what is committed is safe, and begins where the vehicle is.
TEST(AnyPlan, EverythingThatIsCommittedIsSafe) {
  Random random(5);
  int commits = 0;
  for (int world = 0; world < 25; ++world) {
    const MapSpec spec{.wall_x_m = random.uniform(3, 15),
                       .gap_y_m = random.uniform(-4, 4),
                       .seen_until_x_m = random.chance(0.5) ? random.uniform(5, 20) : 99.0};
    Harness h(spec);
    for (int i = 0; i < 12; ++i) {
      const FlatState then = h.ahead(0.05);
      std::vector<Vec3> points{h.place() + 0.05 * Vec3::Random()};
      for (int k = 1 + random.below(8); k > 0; --k) {
        points.push_back(points.back() + Vec3(random.uniform(-0.5, 1.5), random.uniform(-1, 1),
                                              random.uniform(-0.4, 0.4)));
      }
      const Plan plan = random.chance(0.3)
                            ? path_plan(std::move(points))
                            : spline_plan(points, random.uniform(0.1, 1.0),
                                          h.now - std::int64_t(random.uniform(-0.5, 0.5) * 1e9));
      const auto decision = h.send(plan);
      EXPECT_EQ(decision.commit_id != 0, decision.verdict != Verdict::refused);
      if (decision.verdict == Verdict::refused) {
        EXPECT_NE(decision.reason.code, ErrorCode::ok);
        EXPECT_FALSE(decision.reason.message.empty());
      } else {
        ++commits;
        expect_safe(h, h.last());
        if (h.last().start_time_ns() == h.now + kSecond / 20) {
          EXPECT_LT((h.last().flown().sample(0.0).position - then.position).norm(), 0.021);
        }
      }
      h.pass(random.uniform(0.1, 1.0));
    }
  }
  EXPECT_GT(commits, 100);
}

}  // namespace
}  // namespace goshawk::guard
