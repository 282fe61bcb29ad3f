#include "common/measure.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

namespace goshawk::bench {
namespace {

TEST(Measure, runs_every_contender_once_a_round_and_once_before) {
  int a = 0;
  int b = 0;
  std::string order;
  const auto timings =
      compare("both", {{"a", [&] { ++a, order += 'a'; }}, {"b", [&] { ++b, order += 'b'; }}}, 3);
  EXPECT_EQ(a, 4);
  EXPECT_EQ(b, 4);
  EXPECT_EQ(order,
            "ab"
            "ab"
            "ba"
            "ab");
  ASSERT_EQ(timings.size(), 2u);
  EXPECT_EQ(timings[0].sorted_us.size(), 3u);
  EXPECT_EQ(timings[1].sorted_us.size(), 3u);
}

TEST(Measure, can_be_used_many_times) {
  for (int i = 1; i < 4; ++i) {
    EXPECT_EQ(compare("again", {{"x", [] {}}}, i)[0].sorted_us.size(), std::size_t(i));
  }
}

TEST(Measure, takes_quantiles_by_nearest_rank) {
  Timing t{{1, 2, 3, 4, 5, 6, 7, 8, 9, 10}};
  EXPECT_EQ(t.median_us(), 5.0);
  EXPECT_EQ(t.p90_us(), 9.0);
  EXPECT_EQ(t.quantile_us(0.0), 1.0);
  EXPECT_EQ(t.quantile_us(1.0), 10.0);
  t.append({{0.5, 11}});
  EXPECT_EQ(t.quantile_us(0.0), 0.5);
  EXPECT_EQ(t.quantile_us(1.0), 11.0);
  EXPECT_EQ(median({3, 1, 2}), 2.0);
}

TEST(Measure, does_not_answer_for_nothing) {
  EXPECT_THROW(Timing{}.median_us(), std::logic_error);
  EXPECT_THROW(median({}), std::logic_error);
  EXPECT_THROW(compare("none", {}, 0), std::logic_error);
}

}  // namespace
}  // namespace goshawk::bench
