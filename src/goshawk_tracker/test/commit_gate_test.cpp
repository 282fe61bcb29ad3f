#include "goshawk/tracker/commit_gate.hpp"

#include <gmock/gmock.h>

#include "trajectories.hpp"

namespace goshawk::tracker {
namespace {

using testing::HasSubstr;

std::int64_t after(double s) {
  return std::int64_t(s * 1e9);
}

Config config_with(SecondOpinion opinion) {
  Config config;
  config.map_wait_s = 0.5;
  config.second_opinion = opinion;
  config.second_opinion_wait_s = 1.0;
  return config;
}

/// At time zero.
Commit commit(std::uint64_t id, std::uint64_t map_version) {
  const Draft draft = straight_line({0, 0, 1}, {1, 0, 1}, 4.0);
  auto certified =
      certify(draft.trajectory, draft.polytopes, draft.limits, draft.start, draft.goal);
  return {CommittedTrajectory::make({.id = id,
                                     .nominal = std::move(certified).value(),
                                     .map_version = map_version})
              .value()};
}

TEST(CommitGate, LetsACommitPassAtOnceIfItsMapIsThere) {
  CommitGate gate(config_with(SecondOpinion::heed));
  EXPECT_FALSE(gate.release(true, 7, 0));
  EXPECT_FALSE(gate.put(commit(3, 7)));
  const auto release = gate.release(true, 7, 0);
  ASSERT_TRUE(release);
  EXPECT_EQ(release->commit.trajectory.id(), 3U);
  EXPECT_TRUE(release->verdict);
  EXPECT_FALSE(gate.release(true, 7, 0)) << "once";
}

TEST(CommitGate, WaitsForOdometryAsLongAsItTakes) {
  CommitGate gate(config_with(SecondOpinion::off));
  gate.put(commit(3, 7));
  EXPECT_FALSE(gate.release(false, 7, after(100.0)));
  EXPECT_TRUE(gate.release(true, 7, after(100.0)));
}

TEST(CommitGate, WaitsForTheMapVersionThatIsNamedUpToItsBound) {
  for (const auto& older : {std::optional<std::uint64_t>(6), std::optional<std::uint64_t>()}) {
    CommitGate gate(config_with(SecondOpinion::off));
    gate.put(commit(3, 7));
    EXPECT_FALSE(gate.release(true, older, after(0.49)));
    EXPECT_TRUE(gate.release(true, older, after(0.5)));
    gate.put(commit(4, 7));
    EXPECT_FALSE(gate.release(true, older, after(0.1)));
    EXPECT_TRUE(gate.release(true, 8, after(0.1))) << "a newer one is as good";
  }
}

TEST(CommitGate, WaitsForNoMapIfNoneIsRequired) {
  Config config = config_with(SecondOpinion::off);
  config.require_map = false;
  CommitGate gate(config);
  gate.put(commit(3, 7));
  EXPECT_TRUE(gate.release(true, {}, 0));
}

TEST(CommitGate, ANewerCommitTakesThePlaceOfOneThatWaits) {
  CommitGate gate(config_with(SecondOpinion::off));
  EXPECT_FALSE(gate.put(commit(3, 7)));
  EXPECT_EQ(gate.put(commit(4, 5)), 3U);
  EXPECT_EQ(gate.release(true, 5, 0)->commit.trajectory.id(), 4U);
}

TEST(CommitGate, ATrajectoryThatIsFoundTouchingIsRefusedWheneverThatWasSaid) {
  for (const SecondOpinion opinion : {SecondOpinion::heed, SecondOpinion::require}) {
    CommitGate gate(config_with(opinion));
    gate.hear(3, {ErrorCode::collision, "touches at (1, 2, 3) m"});
    gate.hear(3, {ErrorCode::ok, ""});  // from any process
    gate.put(commit(3, 7));
    const auto release = gate.release(true, 7, 0);
    ASSERT_TRUE(release);
    EXPECT_EQ(release->verdict.code(), ErrorCode::collision);
    EXPECT_THAT(release->verdict.error().message, HasSubstr("touches at (1, 2, 3) m"));
  }
}

TEST(CommitGate, WithTheSecondOpinionOffNothingIsHeard) {
  CommitGate gate(config_with(SecondOpinion::off));
  gate.hear(3, {ErrorCode::collision, "touches"});
  gate.put(commit(3, 7));
  EXPECT_TRUE(gate.release(true, 7, 0)->verdict);
}

TEST(CommitGate, HeedDoesNotWaitForAVerdict) {
  CommitGate gate(config_with(SecondOpinion::heed));
  gate.hear(3, {ErrorCode::no_map, "no map came yet"});
  gate.put(commit(3, 7));
  EXPECT_TRUE(gate.release(true, 7, 0)->verdict);
}

TEST(CommitGate, RequireWaitsForTheVerdictOfThatTrajectory) {
  CommitGate gate(config_with(SecondOpinion::require));
  gate.put(commit(3, 7));
  gate.hear(2, {ErrorCode::ok, ""});
  gate.hear(0, {ErrorCode::ok, "ready"});
  EXPECT_FALSE(gate.release(true, 7, after(0.9)));
  gate.hear(3, {ErrorCode::ok, ""});
  const auto release = gate.release(true, 7, after(0.9));
  ASSERT_TRUE(release);
  EXPECT_TRUE(release->verdict);
}

TEST(CommitGate, RequireRefusesWhatWasNotJudgedInTimeAndSaysWhy) {
  CommitGate gate(config_with(SecondOpinion::require));
  gate.put(commit(3, 7));
  EXPECT_FALSE(gate.release(true, 7, after(0.99)));
  EXPECT_EQ(gate.release(true, 7, after(1.0))->verdict.code(), ErrorCode::stage_silent);
  gate.put(commit(4, 7));
  gate.hear(4, {ErrorCode::no_map, "no map came yet"});
  EXPECT_FALSE(gate.release(true, 7, after(0.99))) << "it may still be judged";
  const auto release = gate.release(true, 7, after(1.0));
  EXPECT_EQ(release->verdict.code(), ErrorCode::no_map);
  EXPECT_THAT(release->verdict.error().message, HasSubstr("no map came yet"));
}

}  // namespace
}  // namespace goshawk::tracker
