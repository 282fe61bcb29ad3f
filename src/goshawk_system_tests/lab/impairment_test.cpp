#include "impairment.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace goshawk::lab {
namespace {

constexpr int kPackets = 20'000;
constexpr double kPeriod_s = 0.001;

struct Passed {
  double came_s;
  double left_s;
};

std::vector<Passed> pass(Impairment& link) {
  std::vector<Passed> passed;
  for (int k = 0; k < kPackets; ++k) {
    const double now_s = 1.0 + k * kPeriod_s;
    for (const double left_s : link.departures(now_s)) passed.push_back({now_s, left_s});
  }
  return passed;
}

bool in_order(const std::vector<Passed>& passed) {
  return std::ranges::is_sorted(passed, {}, &Passed::left_s);
}

TEST(Impairment, WithoutFaultsEverythingPassesAtOnce) {
  Impairment link(1);
  const auto passed = pass(link);
  ASSERT_EQ(passed.size(), std::size_t(kPackets));
  for (const auto& p : passed) ASSERT_EQ(p.left_s, p.came_s);
}

TEST(Impairment, LossAndDuplicatesComeAsOftenAsAskedFor) {
  Impairment link(2);
  link.set({.loss = 0.2});
  // Five standard deviations of a binomial distribution are 0.014.
  EXPECT_NEAR(double(pass(link).size()) / kPackets, 0.8, 0.014);
  link.set({.duplicate = 0.1});
  EXPECT_NEAR(double(pass(link).size()) / kPackets, 1.1, 0.014);
}

TEST(Impairment, JitterDelaysWithinItsBoundAndKeepsTheOrder) {
  Impairment link(3);
  link.set({.delay_s = 0.05, .jitter_s = 0.02});
  const auto passed = pass(link);
  EXPECT_TRUE(in_order(passed));
  const auto delays = [&] {
    std::vector<double> list;
    for (const auto& p : passed) list.push_back(p.left_s - p.came_s);
    return list;
  }();
  EXPECT_GE(*std::ranges::min_element(delays), 0.05 - 1e-9);
  EXPECT_LE(*std::ranges::max_element(delays), 0.07 + 1e-9);
  EXPECT_GT(*std::ranges::max_element(delays), 0.065);
}

TEST(Impairment, PacketsThatAreHeldBackAreOvertaken) {
  Impairment link(4);
  link.set({.reorder = 0.1, .held_back_s = 0.01});
  const auto passed = pass(link);
  ASSERT_EQ(passed.size(), std::size_t(kPackets));
  EXPECT_FALSE(in_order(passed));
  const auto late = std::ranges::count_if(
      passed, [](const Passed& p) { return p.left_s > p.came_s + 0.5 * 0.01; });
  EXPECT_NEAR(double(late) / kPackets, 0.1, 0.011);
}

TEST(Impairment, NothingPassesACut) {
  Impairment link(5);
  link.cut_until(3.0);
  EXPECT_TRUE(link.departures(2.999).empty());
  EXPECT_EQ(link.departures(3.0), std::vector{3.0});
}

TEST(Impairment, TheSameSeedGivesTheSameFaults) {
  const LinkFaults faults{.jitter_s = 0.1, .loss = 0.3, .duplicate = 0.3, .reorder = 0.3};
  Impairment a(6);
  Impairment b(6);
  a.set(faults);
  b.set(faults);
  for (int k = 0; k < 1000; ++k) ASSERT_EQ(a.departures(k), b.departures(k));
}

}  // namespace
}  // namespace goshawk::lab
