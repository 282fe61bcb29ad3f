#include "goshawk/stage/sender_clock.hpp"

#include <gmock/gmock.h>

#include "goshawk/core/random.hpp"

namespace goshawk::stage {
namespace {

constexpr std::int64_t kOneMs = 1'000'000;
constexpr std::int64_t kOneSecond = 1000 * kOneMs;
constexpr std::int64_t kWallClock =
    1'700'000'000 * kOneSecond;  // own wall clock at monotonic time 0

/// A sender whose wall clock is skew_ns ahead, over a way that takes delay_ns.
struct ClockPair {
  SenderClock clock;
  std::int64_t now_ns = 0;
  std::int64_t wall_at_0_ns = kWallClock;  // own
  std::int64_t true_wall_ns() const { return kWallClock + now_ns; }

  void send(std::int64_t skew_ns, std::int64_t delay_ns) {
    now_ns += kOneSecond / 2;
    clock.hear(true_wall_ns() - delay_ns + skew_ns, now_ns);
  }
  /// Of a message that was sent long ago, so that its own stamp does not tell.
  std::int64_t skew_ns() const { return skew_ns(0); }
  std::int64_t skew_ns(std::int64_t sent_ns) const {
    return clock.skew_ns(wall_at_0_ns + now_ns, now_ns, sent_ns);
  }
};

TEST(SenderClock, SaysNothingBeforeTheFirstMessage) {
  EXPECT_EQ(ClockPair{}.skew_ns(), 0);
}

TEST(SenderClock, ClocksThatAgreeStayAsTheyAreWhateverTheNetworkDoes) {
  Random random(1);
  ClockPair pair;
  for (int k = 0; k < 200; ++k) {
    pair.send(0, std::int64_t(random.uniform(0.0, 90.0) * kOneMs));
    ASSERT_EQ(pair.skew_ns(), 0) << k;
  }
}

TEST(SenderClock, FindsASkewUpToTheTimeOnTheWay) {
  for (const std::int64_t skew : {3 * kOneSecond, -3 * kOneSecond, 9 * kOneSecond, -300 * kOneMs}) {
    Random random(2);
    ClockPair pair;
    for (int k = 0; k < 50; ++k) {
      pair.send(skew, std::int64_t(random.uniform(40.0, 60.0) * kOneMs));
      ASSERT_NEAR(double(pair.skew_ns()), double(skew - 50 * kOneMs), double(11 * kOneMs));
    }
    EXPECT_TRUE(SenderClock::check(pair.skew_ns(), "the navigator"));
  }
}

TEST(SenderClock, AMessageThatIsLateForOnceChangesNothing) {
  ClockPair pair;
  for (int k = 0; k < 4; ++k) pair.send(3 * kOneSecond, 10 * kOneMs);
  const std::int64_t before = pair.skew_ns();
  pair.send(3 * kOneSecond, 400 * kOneMs);
  EXPECT_EQ(pair.skew_ns(), before);
}

TEST(SenderClock, FollowsOwnAndForeignClocksThatAreSet) {
  ClockPair pair;
  for (int k = 0; k < 8; ++k) pair.send(0, 1 * kOneMs);
  pair.wall_at_0_ns += 5 * kOneSecond;  // this host's clock is set; messages from before stay
  EXPECT_EQ(pair.skew_ns(), -5 * kOneSecond - 1 * kOneMs);
  pair.send(5 * kOneSecond, 1 * kOneMs);  // the sender is on this host, and sees the same clock
  EXPECT_EQ(pair.skew_ns(), 0);
  pair.wall_at_0_ns -= 7 * kOneSecond;
  pair.send(-2 * kOneSecond, 1 * kOneMs);
  EXPECT_EQ(pair.skew_ns(), 0) << "older messages seem to come from the future";
}

TEST(SenderClock, ForgetsWhatCameBeforeTheClockOfAllHostsWasSet) {
  ClockPair pair;
  for (int k = 0; k < 8; ++k) pair.send(0, 1 * kOneMs);
  pair.wall_at_0_ns -= 5 * kOneSecond;
  pair.send(-5 * kOneSecond, 1 * kOneMs);
  pair.send(-5 * kOneSecond, 300 * kOneMs);  // late, so that the others are asked
  EXPECT_EQ(pair.skew_ns(), 0);
}

TEST(SenderClock, AMessageWhoseOwnStampAgreesIsDatedByIt) {
  ClockPair pair;
  for (int k = 0; k < 8; ++k) pair.send(0, 1 * kOneMs);
  pair.wall_at_0_ns -= 5 * kOneSecond;  // of all hosts; the next regular message is still to come
  EXPECT_EQ(pair.skew_ns(pair.wall_at_0_ns + pair.now_ns - 2 * kOneMs), 0);
  EXPECT_EQ(pair.skew_ns(pair.wall_at_0_ns + pair.now_ns + 4 * kOneSecond),
            5 * kOneSecond - kOneMs);
}

// It looks like lateness at first.
TEST(SenderClock, FollowsASmallStepBackWithTheSecondMessageAfterIt) {
  Random random(3);
  for (const std::int64_t back : {150 * kOneMs, 500 * kOneMs, 990 * kOneMs}) {
    ClockPair pair;
    for (int k = 0; k < 8; ++k) pair.send(0, std::int64_t(random.uniform(0.1, 2.0) * kOneMs));
    pair.send(-back, 1 * kOneMs);
    EXPECT_EQ(pair.skew_ns(), 0) << "it may have been late";
    pair.send(-back, 1 * kOneMs);
    EXPECT_EQ(pair.skew_ns(), -back - kOneMs);
  }
}

TEST(SenderClock, FollowsAStepForwardWithTheFirstMessageAfterIt) {
  for (const std::int64_t ahead : {150 * kOneMs, 500 * kOneMs, 3 * kOneSecond}) {
    ClockPair pair;
    for (int k = 0; k < 8; ++k) pair.send(0, 1 * kOneMs);
    pair.send(ahead, 1 * kOneMs);
    EXPECT_EQ(pair.skew_ns(), ahead - kOneMs);
  }
}

// A burst waits in one queue, so that all of it is late by the same.
TEST(SenderClock, LateMessagesOfOneMomentChangeNothing) {
  ClockPair pair;
  for (int k = 0; k < 4; ++k) pair.send(3 * kOneSecond, 10 * kOneMs);
  const std::int64_t before = pair.skew_ns();
  pair.send(3 * kOneSecond, 400 * kOneMs);
  for (int k = 0; k < 3; ++k) {
    pair.now_ns += 50 * kOneMs;
    pair.clock.hear(pair.true_wall_ns() - 400 * kOneMs + 3 * kOneSecond, pair.now_ns);
  }
  EXPECT_EQ(pair.skew_ns(), before);
}

TEST(SenderClock, NamesASkewThatIsTooLarge) {
  EXPECT_TRUE(SenderClock::check(10 * kOneSecond, "the navigator"));
  const Status ahead = SenderClock::check(25 * kOneSecond, "the navigator");
  EXPECT_EQ(ahead.code(), ErrorCode::clock_set);
  EXPECT_THAT(ahead.error().message,
              testing::HasSubstr("clock skew: the clock of the navigator's host is 25 s ahead"));
  EXPECT_THAT(SenderClock::check(-25 * kOneSecond, "the navigator").error().message,
              testing::HasSubstr("25 s behind"));
}

}  // namespace
}  // namespace goshawk::stage
