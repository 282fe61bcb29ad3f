#include "goshawk/closed_loop/flight_lab.hpp"

#include <gtest/gtest.h>

#include "goshawk/closed_loop/obstacle_distance.hpp"
#include "goshawk/core/inflation.hpp"

namespace goshawk::closed_loop {
namespace {

const Vec3 kThere(3.0, 7.0, 1.5);

/// An empty hall with a wall across that leaves a gap.
std::shared_ptr<const VoxelGrid> hall() {
  GridGeometry geometry{.resolution_m = 0.2, .size = {30, 45, 15}};
  BitGrid raw(geometry.size, true, false);
  for (int z = 0; z < 15; ++z) {
    for (int x = 0; x < 20; ++x) raw.set({x, 20, z}, true);
  }
  const double radius_m = kBody_m + kTrackingMargin_m;
  return std::make_shared<const VoxelGrid>(
      VoxelGrid{.geometry = geometry,
                .grown = inflate(raw, radius_m, geometry.resolution_m).value(),
                .known = {},
                .raw = raw,
                .version = 1,
                .inflation_m = radius_m});
}

Setup setup(Tracking tracking, double computing_s = 0.0) {
  Setup s;
  s.tracking = tracking;
  s.home_map = Vec3(3.0, 1.0, 1.5);
  s.delays.plan_max_s = s.delays.plan_min_s;
  s.delays.stopwatch = [computing_s](const std::function<void()>& work) {
    work();
    return computing_s / 3.0;  // of each stage
  };
  return s;
}

bool arrives(FlightLab& lab) {
  if (!lab.goal(kThere)) return false;
  lab.run(30.0, [&] { return lab.settled(); });
  return lab.state().state == navigator::State::arrived;
}

TEST(FlightLab, FliesAroundTheWallByEitherTracking) {
  for (const Tracking tracking : {Tracking::physical, Tracking::ideal}) {
    FlightLab lab(hall(), 1, setup(tracking));
    int commits = 0;
    lab.on_commit = [&](const CommittedTrajectory&) { ++commits; };
    EXPECT_TRUE(arrives(lab));
    EXPECT_EQ(lab.contacts(), 0);
    EXPECT_EQ(commits, lab.commits());
    EXPECT_LT((lab.position() - kThere).norm(), 0.1);
    EXPECT_EQ(int(lab.replans().size()), lab.plans());
  }
}

TEST(FlightLab, IdealTrackingHasNoError) {
  FlightLab lab(hall(), 1, setup(Tracking::ideal));
  ASSERT_TRUE(arrives(lab));
  EXPECT_LT(lab.max_error_m(), 1e-4);
}

TEST(FlightLab, RepeatsToTheBitIfTheStopwatchDoes) {
  FlightLab one(hall(), 5, setup(Tracking::physical, 0.003));
  FlightLab other(hall(), 5, setup(Tracking::physical, 0.003));
  EXPECT_TRUE(arrives(one));
  EXPECT_TRUE(arrives(other));
  EXPECT_EQ(one.now_ns(), other.now_ns());
  EXPECT_EQ(one.position(), other.position());
  EXPECT_EQ(one.velocity(), other.velocity());
}

TEST(FlightLab, ASlowPlannerBeginsLater) {
  const auto begins_s = [](double computing_s) {
    FlightLab lab(hall(), 1, setup(Tracking::physical, computing_s));
    EXPECT_TRUE(lab.goal(kThere));
    EXPECT_TRUE(lab.run(5.0, [&] { return lab.flown().has_value(); }));
    return lab.now_s();
  };
  EXPECT_NEAR(begins_s(0.4) - begins_s(0.0), 0.4, 0.03);
}

TEST(FlightLab, TheProcessorsTimeOfWorkIsMeasured) {
  volatile double sum = 0.0;
  const double took_s = processor_time_s([&] {
    for (int i = 0; i < 3'000'000; ++i) sum = sum + double(i);
  });
  EXPECT_GT(took_s, 0.0);
  EXPECT_GT(sum, 0.0);
}

}  // namespace
}  // namespace goshawk::closed_loop
