#include "goshawk/stage/life_sign.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "goshawk/conversions/status.hpp"
#include "two_nodes.hpp"

namespace goshawk::stage {
namespace {

using goshawk_msgs::msg::NavigatorState;

constexpr std::int64_t kSecond_ns = 1'000'000'000;

struct LifeSignTest : testing::Test {
  LifeSignTest() {
    nodes.clock->set(100 * kSecond_ns);
    state.request_id(7);
    state.header(conversions::make_header(nodes.clock->now_ns()));
    nodes.other.subscribe<NavigatorState>(
        "navigator_alive", runtime::Qos::best_effort(),
        [this](const NavigatorState& m, const auto&) { heard.push_back(m); });
    sign.emplace(nodes.stage, reporter, state);
    // Each may find the other first, and what is not heard is not sent again.
    nodes.spin_until([&] {
      nodes.clock->step_wall_clock(kSecond_ns);
      sign->before_commit();
      return !heard.empty();
    });
    heard.clear();
  }
  bool hears(std::size_t count) {
    return nodes.spin_until([&] { return heard.size() >= count; });
  }
  std::int64_t stamp_ns(std::size_t k) const {
    return conversions::to_ns(heard.at(k).header().stamp());
  }

  stage_test::TwoNodes nodes;
  StageReporter reporter{nodes.stage, StageRole::navigator, "test"};
  NavigatorState state;
  std::optional<LifeSign> sign;
  std::vector<NavigatorState> heard;
};

TEST_F(LifeSignTest, RepeatsTheStateWithTheTimeAtWhichItIsSent) {
  nodes.spin_until([this] {
    nodes.clock->advance(kSecond_ns / 2);
    return heard.size() >= 2;
  });
  ASSERT_GE(heard.size(), 2U);
  EXPECT_EQ(heard[1].request_id(), 7U);
  EXPECT_GT(stamp_ns(1), stamp_ns(0)) << "an old stamp looks like a clock that is behind";
}

TEST_F(LifeSignTest, ComesBeforeACommitIfTheClockWasSetAndElseWhenItIsDue) {
  sign->before_commit();
  nodes.clock->step_wall_clock(-3 * kSecond_ns);
  sign->before_commit();
  sign->before_commit();
  ASSERT_TRUE(hears(1));
  EXPECT_EQ(stamp_ns(0), nodes.clock->now_ns());
  nodes.clock->step_wall_clock(5 * kSecond_ns);
  sign->before_commit();
  ASSERT_TRUE(hears(2));
  EXPECT_EQ(heard.size(), 2U);
  EXPECT_EQ(stamp_ns(1), nodes.clock->now_ns());
}

}  // namespace
}  // namespace goshawk::stage
