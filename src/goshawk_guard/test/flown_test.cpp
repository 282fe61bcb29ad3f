#include "goshawk/guard/flown.hpp"

#include <gtest/gtest.h>

namespace goshawk::guard {
namespace {

constexpr std::int64_t kOneSecond = 1'000'000'000;
const std::vector kRoom{Polytope::box(Vec3(-50, -50, -50), Vec3(50, 50, 50))};

/// From x to x + 2 m in 4 s, from rest to rest.
CommittedTrajectory leg(std::uint64_t id, double x_m, std::int64_t start_ns) {
  const FlatState a{.position = {x_m, 0, 1}}, b{.position = {x_m + 2.0, 0, 1}};
  auto nominal = certify({{BezierPiece::between(a, b, 4.0)}}, kRoom,
                         {.v_max_m_s = 9.0, .a_max_m_s2 = 9.0}, a, b)
                     .value();
  return CommittedTrajectory::make(
             {.id = id, .nominal = std::move(nominal), .start_time_ns = start_ns})
      .value();
}

Tracking holds(double x_m) {
  return {Tracking::Mode::holds, {x_m, 0, 1}};
}

TEST(Flown, IsUnknownUntilTheTrackerHolds) {
  Flown flown;
  EXPECT_FALSE(flown.at(0));
  flown.hear({Tracking::Mode::follows, {1, 0, 1}}, 0);
  EXPECT_FALSE(flown.at(0)) << "something that is not the guard's";
  flown.hear(holds(1.0), 0);
  ASSERT_TRUE(flown.at(kOneSecond));
  EXPECT_EQ(flown.at(kOneSecond)->position, Vec3(1, 0, 1));
  EXPECT_TRUE(flown.rests_from(0));
}

TEST(Flown, IsACommitFromItsStartToItsEndAndThereafter) {
  Flown flown;
  flown.hear(holds(0.0), 0);
  flown.add(leg(1, 0.0, kOneSecond));
  EXPECT_EQ(flown.at(kOneSecond / 2)->position, Vec3(0, 0, 1));
  EXPECT_NEAR(flown.at(3 * kOneSecond)->position.x(), 1.0, 1e-9);
  EXPECT_EQ(flown.at(9 * kOneSecond)->position, Vec3(2, 0, 1));
  EXPECT_FALSE(flown.rests_from(4 * kOneSecond));
  EXPECT_TRUE(flown.rests_from(5 * kOneSecond));
  EXPECT_EQ(flown.newest(2 * kOneSecond)->id(), 1u);
  EXPECT_EQ(flown.newest(6 * kOneSecond), nullptr);
}

TEST(Flown, ANewerCommitReplacesWhatWaitsForALaterTime) {
  Flown flown;
  flown.hear(holds(0.0), 0);
  flown.add(leg(1, 0.0, 1 * kOneSecond));
  flown.add(leg(2, 5.0, 3 * kOneSecond));
  flown.add(leg(3, 7.0, 2 * kOneSecond));
  EXPECT_GE(flown.at(5 * kOneSecond)->position.x(), 7.0);
}

TEST(Flown, ARefusedCommitLeavesWhatWasFlownBefore) {
  Flown flown;
  flown.hear(holds(0.0), 0);
  flown.add(leg(1, 0.0, 0));
  EXPECT_FALSE(flown.answer(1, true, 0));
  flown.add(leg(2, 5.0, kOneSecond));
  EXPECT_FALSE(flown.answer(2, false, kOneSecond));
  EXPECT_NEAR(flown.at(2 * kOneSecond)->position.x(), 1.0, 1e-9);
  EXPECT_FALSE(flown.answer(77, false, kOneSecond)) << "another's";
  EXPECT_TRUE(flown.at(2 * kOneSecond));
}

TEST(Flown, AfterALossNothingIsKnownUntilTheTrackerHoldsAgain) {
  Flown flown;
  flown.hear(holds(0.0), 0);
  flown.add(leg(1, 0.0, 0));
  flown.answer(1, true, 0);
  EXPECT_TRUE(flown.answer(1, false, kOneSecond));
  EXPECT_FALSE(flown.at(kOneSecond));
  flown.hear({Tracking::Mode::brakes, {0.6, 0, 1}}, kOneSecond);
  EXPECT_FALSE(flown.at(kOneSecond));
  flown.hear(holds(0.7), 2 * kOneSecond);
  EXPECT_EQ(flown.at(2 * kOneSecond)->position, Vec3(0.7, 0, 1));
}

TEST(Flown, ATrackerThatHoldsElsewhereIsBelieved) {
  Flown flown;
  flown.hear(holds(0.0), 0);
  flown.add(leg(1, 0.0, 0));
  flown.answer(1, true, 0);
  flown.hear(holds(0.0), kOneSecond / 10);  // sent before it had the commit
  EXPECT_EQ(flown.legs().size(), 1u);
  flown.hear(holds(2.0), 6 * kOneSecond);
  EXPECT_EQ(flown.at(6 * kOneSecond)->position, Vec3(2, 0, 1));
  flown.hear(holds(3.0), 7 * kOneSecond);
  EXPECT_EQ(flown.at(7 * kOneSecond)->position, Vec3(3, 0, 1));
}

}  // namespace
}  // namespace goshawk::guard
