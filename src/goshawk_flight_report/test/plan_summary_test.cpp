#include "../src/plan_summary.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace goshawk::flight_report {
namespace {

using testing::StartsWith;

/// Along x at 1 m/s, from and to these places.
Leg line(double from_m, double to_m, double start_s) {
  FlatState start, end;
  start.position.x() = from_m;
  end.position.x() = to_m;
  start.velocity.x() = end.velocity.x() = 1.0;
  Leg leg;
  leg.trajectory.pieces = {BezierPiece::between(start, end, to_m - from_m)};
  leg.start_t_s = start_s;
  return leg;
}

TEST(PlanSummary, OnePlanCountsWhole) {
  Flight flight;
  flight.legs = {line(0.0, 10.0, 3.0)};
  EXPECT_THAT(plan_summary(flight),
              StartsWith("planned 10.00 m in 10.00 s, mean 1.00 m/s, top 1.00"));
}

TEST(PlanSummary, APlanCountsUntilTheNextOneTakesOver) {
  Flight flight;
  flight.legs = {line(0.0, 10.0, 3.0), line(4.0, 12.0, 7.0), line(9.0, 11.0, 12.0)};
  EXPECT_THAT(plan_summary(flight), StartsWith("planned 11.00 m in 11.00 s, mean 1.00 m/s"));
}

TEST(PlanSummary, APlanThatIsReplacedBeforeItBeginsDoesNotCount) {
  Flight flight;
  flight.legs = {line(0.0, 10.0, 3.0), line(4.0, 90.0, 7.0), line(2.0, 6.0, 5.0)};
  EXPECT_THAT(plan_summary(flight), StartsWith("planned 6.00 m in 6.00 s"));
}

TEST(PlanSummary, WithoutTrajectoriesThereIsNothingToSay) {
  Flight flight;
  flight.legs.resize(2);
  EXPECT_EQ(plan_summary(flight), "");
}

}  // namespace
}  // namespace goshawk::flight_report
