// The second opinion in flight, second by second.
#include "goshawk/flight_check/watch.hpp"

#include <gmock/gmock.h>

#include "worlds.hpp"

namespace goshawk::flight_check::test {
namespace {

using Kind = Finding::Kind;
using ::testing::HasSubstr;

constexpr double kSpeed_m_s = 1.0;

FlightCheck wall_at(int voxel_x) {
  return FlightCheck::from_tree(tree_of(wall_at_x(voxel_x, 20))).value();
}

/// Along x from from_m to to_m, at 1 m/s and 100 Hz.
std::vector<Sample> straight(double from_m, double to_m) {
  std::vector<Sample> track;
  const int steps = int(std::lround(std::abs(to_m - from_m) / kSpeed_m_s * 100.0));
  for (int k = 0; k <= steps; ++k) {
    track.push_back(at(0.01 * k, Vec3(from_m + (to_m - from_m) * k / steps, 0.03, 0.03)));
  }
  return track;
}

Plan plan(std::uint64_t id, double start_s, double from_m, double to_m) {
  return {id, start_s, straight(from_m, to_m), {}};
}

class WatchTest : public ::testing::Test {
 protected:
  /// As a vehicle flies, with a tick each 0.2 s.
  void fly(double start_s, double from_m, double to_m) {
    int count = 0;
    for (const Sample& s : straight(from_m, to_m)) {
      const double t_s = start_s + s.t_s;
      watch.fly({{t_s, s.position_map, s.q_map_base}, kSpeed_m_s});
      if (++count % 20 == 0) watch.tick(t_s);
    }
    watch.tick(start_s + std::abs(to_m - from_m));
  }
  void hover(double start_s, double x_m, double duration_s) {
    for (double t_s = start_s; t_s <= start_s + duration_s; t_s += 0.01) {
      watch.fly({at(t_s, Vec3(x_m, 0.03, 0.03)), 0.0});
    }
    watch.tick(start_s + duration_s);
  }
  std::vector<Finding> found() { return watch.take_findings(); }

  Watch watch;
};

TEST_F(WatchTest, JudgesAPlanAtOnce) {
  watch.set_map(wall_at(20));
  watch.commit(plan(7, 100.0, 0.0, 1.5));
  auto findings = found();
  ASSERT_EQ(findings.size(), 1U);
  EXPECT_EQ(findings[0].kind, Kind::planned);
  EXPECT_EQ(findings[0].request_id, 7U);
  EXPECT_NEAR(findings[0].outcome->clearance_m, 2.0 - 1.5 - 0.15, 1e-3);
  watch.commit(plan(8, 100.0, 0.0, 3.0));
  findings = found();
  ASSERT_EQ(findings.size(), 1U);
  EXPECT_TRUE(findings[0].outcome->touched);
  EXPECT_NEAR(findings[0].outcome->clearance_t_s, 1.85, 1e-3);
}

TEST_F(WatchTest, JudgesTheNominalAndTheStopPart) {
  watch.set_map(wall_at(20));
  const auto stopping = [](double stop_at_m) {
    Plan p = plan(7, 100.0, 0.0, 1.5);
    p.stop = straight(1.0, stop_at_m);
    for (Sample& s : p.stop) s.t_s += 1.0;
    return p;
  };
  watch.commit(stopping(1.2));
  EXPECT_NEAR(found().front().outcome->clearance_m, 0.35, 1e-3);  // the nominal part is nearer
  watch.commit(stopping(1.7));
  EXPECT_NEAR(found().front().outcome->clearance_m, 0.15, 1e-3);
  watch.commit(stopping(2.5));
  const auto findings = found();
  EXPECT_TRUE(findings.front().outcome->touched);
  EXPECT_NEAR(findings.front().outcome->clearance_t_s, 1.85, 1e-3);
}

TEST_F(WatchTest, FollowsTheStopPartToItsEnd) {
  watch.set_map(wall_at(20));
  Plan p = plan(7, 100.0, 0.0, 0.5);
  p.stop = straight(0.2, 1.5);
  for (Sample& s : p.stop) s.t_s += 0.2;
  watch.commit(p);
  found();
  fly(100.0, 0.0, 1.5);
  EXPECT_TRUE(found().empty());
  hover(101.51, 1.5, 1.2);
  const auto findings = found();
  ASSERT_EQ(findings.size(), 1U);
  EXPECT_EQ(findings[0].kind, Kind::flown);
  EXPECT_NEAR(findings[0].outcome->clearance_m, 0.35, 1.1e-3);
}

TEST_F(WatchTest, JudgesAPlanWhenAMapComes) {
  watch.commit(plan(7, 100.0, 0.0, 1.5));
  auto findings = found();
  ASSERT_EQ(findings.size(), 1U);
  EXPECT_EQ(findings[0].outcome.code(), ErrorCode::no_map);
  watch.set_map(wall_at(20));
  watch.tick(99.9);
  findings = found();
  ASSERT_EQ(findings.size(), 1U);
  EXPECT_EQ(findings[0].kind, Kind::planned);
  EXPECT_EQ(findings[0].request_id, 7U);
  EXPECT_FALSE(findings[0].outcome->touched);
}

TEST_F(WatchTest, TellsOnceThatANewMapCutsWhatIsLeftOfThePlan) {
  watch.set_map(wall_at(40));
  watch.commit(plan(7, 100.0, 0.0, 3.0));
  found();
  watch.set_map(wall_at(50));
  watch.tick(100.5);
  EXPECT_TRUE(found().empty());  // still free: no news
  watch.set_map(wall_at(20));
  watch.tick(101.0);
  const auto findings = found();
  ASSERT_EQ(findings.size(), 1U);
  EXPECT_EQ(findings[0].kind, Kind::planned);
  EXPECT_EQ(findings[0].request_id, 7U);
  EXPECT_TRUE(findings[0].outcome->touched);
  watch.set_map(wall_at(20));
  watch.tick(101.2);
  EXPECT_TRUE(found().empty());
}

TEST_F(WatchTest, DoesNotMindAnObstacleWhereThePlanHasBeen) {
  watch.set_map(wall_at(40));
  watch.commit(plan(7, 100.0, 0.0, 3.0));
  found();
  watch.set_map(wall_at(5));
  watch.tick(101.5);
  EXPECT_TRUE(found().empty());
}

TEST_F(WatchTest, TellsTheSmallestClearanceOfALegWhenItIsOver) {
  watch.set_map(wall_at(20));
  watch.commit(plan(7, 100.0, 0.0, 1.5));
  found();
  fly(100.0, 0.0, 1.5);
  EXPECT_TRUE(found().empty());
  hover(101.51, 1.5, 1.2);
  const auto findings = found();
  ASSERT_EQ(findings.size(), 1U);
  EXPECT_EQ(findings[0].kind, Kind::flown);
  EXPECT_EQ(findings[0].request_id, 7U);
  EXPECT_NEAR(findings[0].outcome->clearance_m, 0.35, 1.1e-3);
  hover(102.72, 1.5, 1.0);
  EXPECT_TRUE(found().empty());
}

TEST_F(WatchTest, TellsWhatWasFlownOfAPlanThatIsSuperseded) {
  watch.set_map(wall_at(20));
  watch.commit(plan(7, 100.0, 0.0, 1.5));
  fly(100.0, 0.0, 1.0);
  found();
  watch.commit(plan(8, 101.0, 1.0, 0.5));
  const auto findings = found();
  ASSERT_EQ(findings.size(), 2U);
  EXPECT_EQ(findings[0].kind, Kind::flown);
  EXPECT_EQ(findings[0].request_id, 7U);
  EXPECT_NEAR(findings[0].outcome->clearance_m, 0.85, 1.1e-3);
  EXPECT_EQ(findings[1].kind, Kind::planned);
  EXPECT_EQ(findings[1].request_id, 8U);
}

TEST_F(WatchTest, CountsWhatWasFlownSinceTheLastTickToThePlanBefore) {
  for (const bool judged : {true, false}) {
    SCOPED_TRACE(judged);
    watch = {};
    watch.set_map(wall_at(20));
    watch.commit(plan(7, 100.0, 0.0, 1.5));
    for (const Sample& s : straight(0.0, 1.5)) {  // no tick comes
      watch.fly({{100.0 + s.t_s, s.position_map, s.q_map_base}, kSpeed_m_s});
    }
    found();
    if (judged) {
      watch.commit(plan(8, 101.5, 1.5, 0.5));
    } else {
      watch.commit_unjudged(8, fail(ErrorCode::invalid_input, "no piece"));
    }
    auto findings = found();
    ASSERT_EQ(findings.size(), 2U);
    EXPECT_EQ(findings[0].kind, Kind::flown);
    EXPECT_EQ(findings[0].request_id, 7U);
    EXPECT_NEAR(findings[0].outcome->clearance_m, 0.35, 1.1e-3);
    if (!judged) continue;
    fly(101.51, 1.5, 0.5);
    hover(102.52, 0.5, 1.2);
    findings = found();
    ASSERT_EQ(findings.size(), 1U);
    EXPECT_EQ(findings[0].request_id, 8U);
    EXPECT_NEAR(findings[0].outcome->clearance_m, 0.35, 1.1e-3);
  }
}

TEST_F(WatchTest, TellsAContactOnceAndTheNextOneAgain) {
  watch.set_map(wall_at(20));
  fly(100.0, 0.0, 2.0);
  hover(102.01, 2.0, 0.5);
  auto findings = found();
  ASSERT_EQ(findings.size(), 1U);
  EXPECT_EQ(findings[0].kind, Kind::contact);
  EXPECT_EQ(findings[0].request_id, 0U);
  EXPECT_NEAR(findings[0].outcome->clearance_t_s, 101.85, 1e-3);
  fly(102.6, 2.0, 0.0);
  fly(104.61, 0.0, 2.0);
  findings = found();
  ASSERT_EQ(findings.size(), 1U);
  EXPECT_NEAR(findings[0].outcome->clearance_t_s, 104.61 + 1.85, 1e-3);
}

TEST_F(WatchTest, TakesAJumpForAnEventAndNotForAFlightThroughAWall) {
  watch.set_map(wall_at(20));
  watch.commit(plan(7, 100.0, 0.0, 1.5));
  fly(100.0, 0.0, 1.0);
  found();
  fly(101.004, 5.0, 4.0);  // a restarted plant, behind the wall
  const auto findings = found();
  ASSERT_EQ(findings.size(), 2U);
  EXPECT_EQ(findings[0].kind, Kind::flown);
  EXPECT_NEAR(findings[0].outcome->clearance_m, 0.85, 1.1e-3);
  EXPECT_EQ(findings[1].kind, Kind::event);
  EXPECT_EQ(findings[1].outcome.code(), ErrorCode::tracking_lost);
  EXPECT_THAT(findings[1].outcome.error().message, HasSubstr("jumped by 4.00 m"));
  fly(102.01, 4.0, 2.0);  // and it is watched on: it flies into the wall from behind
  ASSERT_EQ(found().front().kind, Kind::contact);
}

TEST_F(WatchTest, TakesAClockThatWentBackAndAGapForEvents) {
  watch.set_map(wall_at(20));
  fly(100.0, 0.0, 1.0);
  fly(0.0, 5.0, 4.0);
  fly(9.0, 1.0, 0.0);
  const auto findings = found();
  ASSERT_EQ(findings.size(), 2U);
  for (const auto& finding : findings) EXPECT_EQ(finding.kind, Kind::event);
}

TEST_F(WatchTest, JudgesNothingAcrossAResetThatItIsToldOf) {
  watch.set_map(wall_at(20));
  fly(100.0, 0.0, 1.8);
  watch.forget_track();
  fly(101.8, 2.3, 3.0);
  EXPECT_TRUE(found().empty());
}

TEST_F(WatchTest, DoesNotJudgeWhatWasFlownBeforeAnyMap) {
  fly(100.0, 0.0, 3.0);
  watch.set_map(wall_at(20));
  fly(103.0, 3.0, 4.0);
  EXPECT_TRUE(found().empty());
}

TEST_F(WatchTest, SaysWhyAPlanCannotBeJudgedAndWatchesOn) {
  watch.set_map(wall_at(20));
  watch.commit_unjudged(9, fail(ErrorCode::invalid_input, "no piece"));
  const auto findings = found();
  ASSERT_EQ(findings.size(), 1U);
  EXPECT_EQ(findings[0].request_id, 9U);
  EXPECT_EQ(findings[0].outcome.code(), ErrorCode::invalid_input);
  fly(100.0, 0.0, 2.0);
  EXPECT_EQ(found().front().kind, Kind::contact);
}

}  // namespace
}  // namespace goshawk::flight_check::test
