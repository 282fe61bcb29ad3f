#include <cmath>
#include <limits>

#include "harness.hpp"

namespace goshawk::guard {
namespace {

using testing::HasSubstr;
const Vec3 kThere(9.1, 0.1, 2.1);

void expect_refused(Harness& h, const Plan& plan, ErrorCode code, const char* words) {
  const auto decision = h.send(plan);
  EXPECT_EQ(decision.verdict, Verdict::refused);
  EXPECT_EQ(decision.reason.code, code)
      << to_string(decision.reason.code) << ": " << decision.reason.message;
  EXPECT_THAT(decision.reason.message, HasSubstr(words));
  EXPECT_EQ(decision.commit_id, 0u);
  EXPECT_TRUE(h.commits.empty());
}

Plan timed_plan(std::vector<Sample> samples) {
  return {.kind = PlanKind::trajectory, .shape = Samples{std::move(samples)}};
}

TEST(BadPlans, BeforeAMapCameAreRefused) {
  Guard guard({}, make_repair(), 1);
  guard.on_tracking({Tracking::Mode::holds, kHome}, 0);
  EXPECT_EQ(guard.on_plan(path_plan({kHome, kThere}), 0).reason.code, ErrorCode::no_map);
}

TEST(BadPlans, BeforeTheTrackerSpokeAreRefused) {
  Guard guard({}, make_repair(), 1);
  guard.set_map(map_of({}), 0);
  EXPECT_EQ(guard.on_plan(path_plan({kHome, kThere}), 0).reason.code, ErrorCode::not_at_start);
  EXPECT_EQ(guard.on_plan(straight_plan(kHome, kThere, 9), 0).reason.code, ErrorCode::not_at_start);
}

TEST(BadPlans, BeforeOdometryCameAreRefused) {
  Guard guard({}, make_repair(), 1);
  guard.set_map(map_of({}), 0);
  guard.on_tracking({Tracking::Mode::holds, kHome}, 0);
  const auto decision = guard.on_plan(path_plan({kHome, kThere}), 0);
  EXPECT_EQ(decision.reason.code, ErrorCode::not_at_start);
  EXPECT_THAT(decision.reason.message, HasSubstr("heading"));
  guard.on_heading(kYaw_rad);
  EXPECT_EQ(guard.on_plan(path_plan({kHome, kThere}), 0).verdict, Verdict::passed);
}

TEST(BadPlans, WhoseEndTheVehicleHasReachedAreRefused) {
  Harness h;
  expect_refused(h, path_plan({kHome - Vec3(0.5, 0, 0), kHome}), ErrorCode::deadline_exceeded,
                 "at its end already");
}

TEST(BadPlans, OfNothingOrNotOfNumbersAreRefused) {
  Harness h;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  expect_refused(h, path_plan({}), ErrorCode::invalid_input, "0 points");
  expect_refused(h, path_plan({kHome}), ErrorCode::invalid_input, "1 points");
  expect_refused(h, path_plan({kHome, kHome}), ErrorCode::invalid_input, "the same");
  expect_refused(h, path_plan({kHome, {nan, 0, 0}}), ErrorCode::invalid_input, "point 1");
  expect_refused(h, timed_plan({}), ErrorCode::invalid_input, "0 points");
  expect_refused(h, timed_plan({{0, kHome}, {1, {0, nan, 0}}}), ErrorCode::invalid_input,
                 "point 1");
  expect_refused(h, timed_plan({{0, kHome}, {nan, kThere}}), ErrorCode::invalid_input, "point 1");
  expect_refused(h, {.kind = PlanKind::bspline, .shape = Bspline{}}, ErrorCode::invalid_input,
                 "0 control points");
  expect_refused(h, {.kind = PlanKind::polynomial, .shape = Polynomials{}},
                 ErrorCode::invalid_input, "0 polynomial pieces");
}

TEST(BadPlans, InWhichTimeRunsBackwardsAreRefusedWithThePlace) {
  Harness h;
  expect_refused(h, timed_plan({{0, kHome}, {2, kThere}, {1, kHome}}), ErrorCode::invalid_input,
                 "time does not grow at point 2: 1 s after 2 s");
}

TEST(BadPlans, ThatBeginElsewhereAreRefusedWithThePlace) {
  Harness h;
  const Vec3 off(0, 1.5, 0);
  expect_refused(h, straight_plan(kHome + off, kThere + off, 9), ErrorCode::not_at_start,
                 "plan from there");
  expect_refused(h, path_plan({kHome + off, kThere + off}), ErrorCode::not_at_start,
                 "plan from there");
}

TEST(BadPlans, OfAnotherTimeAreRefused) {
  Harness h;
  expect_refused(h, straight_plan(kHome, kThere, 9, h.now - 10 * kSecond),
                 ErrorCode::deadline_exceeded, "lasts 9 s");
  expect_refused(h, straight_plan(kHome, kThere, 9, h.now + 60 * kSecond), ErrorCode::not_at_start,
                 "are the clocks the same?");
  const auto far = std::numeric_limits<std::int64_t>::max();
  expect_refused(h, straight_plan(kHome, kThere, 9, far), ErrorCode::not_at_start, "clocks");
  expect_refused(h, straight_plan(kHome, kThere, 9, -far), ErrorCode::deadline_exceeded, "clocks");
}

TEST(BadPlans, ThatLastHardlyOrForEverAreRefused) {
  Harness h;
  expect_refused(h, straight_plan(kHome, kThere, 1e-3), ErrorCode::invalid_input, "s apart");
  expect_refused(h, timed_plan({{0, kHome}, {1e-4, kThere}}), ErrorCode::invalid_input,
                 "it lasts 0.0001 s");
  expect_refused(h, straight_plan(kHome, kThere, 1e5), ErrorCode::invalid_input, "it lasts");
}

TEST(BadPlans, LateOnesAreBegunLateFromRestAndJoinedInFlight) {
  Harness h;
  const auto first = h.send(straight_plan(kHome, kThere, 9, h.now - 2 * kSecond));
  EXPECT_EQ(first.verdict, Verdict::passed) << first.reason.message;
  EXPECT_NEAR(h.last().nominal().duration_s(), 9.0, 1e-6);
  h.pass(2.0);
  const auto second = h.send(straight_plan(h.place(), kThere, 9, h.now - kSecond / 5));
  EXPECT_EQ(second.verdict, Verdict::replaced) << second.reason.message;
  expect_safe(h, h.last());
}

TEST(BadPlans, TenThousandPointsAreAnswered) {
  Harness h;
  std::vector<Vec3> straight, zigzag;
  std::vector<Sample> timed;
  for (int i = 0; i < 10'000; ++i) {
    straight.push_back(kHome + i / 9999.0 * (kThere - kHome));
    zigzag.push_back(kHome + Vec3(1e-3 * i, i % 2 ? 0.6 : 0.0, 0.0));
    timed.push_back({1e-3 * i, straight.back()});
  }
  EXPECT_EQ(h.send(path_plan(straight)).verdict, Verdict::passed);
  expect_safe(h, h.last());
  Harness other;
  const auto cut = other.send(path_plan(zigzag));
  if (cut.commit_id != 0) expect_safe(other, other.last());
  EXPECT_NE(cut.reason.code, ErrorCode::ok) << "10,000 corners";
  Harness third;
  EXPECT_NE(third.send(timed_plan(timed)).verdict, Verdict::refused);
  expect_safe(third, third.last());
}

TEST(BadPlans, WithAJumpInTheCurveAreFlownWithoutIt) {
  Harness h;
  Polynomials jump;
  jump.pieces.push_back({2.0, {{{1.1, 0, 0, 0.5}, {0.1}, {2.1}}}});
  jump.pieces.push_back({2.0, {{{5.3, 0.1}, {0.1}, {2.1}}}});
  const auto decision = h.send({.kind = PlanKind::polynomial, .shape = jump});
  EXPECT_NE(decision.verdict, Verdict::passed);
  EXPECT_NE(decision.reason.code, ErrorCode::ok);
  if (decision.commit_id != 0) expect_safe(h, h.last());
}

TEST(BadPlans, AVehicleInAnObstacleIsNotMoved) {
  Harness h({.wall_x_m = 1.0});
  expect_refused(h, straight_plan(kHome, kThere, 9), ErrorCode::trajectory_blocked, "map 7");
}

TEST(BadPlans, AreCountedAndNumbered) {
  Harness h;
  EXPECT_EQ(h.send(path_plan({})).plan, 1u);
  EXPECT_EQ(h.guard.refuse(PlanKind::path, fail(ErrorCode::wrong_frame, "no"), h.now).plan, 2u);
}

}  // namespace
}  // namespace goshawk::guard
