#include "goshawk/obstacle_tracker/obstacle_tracker.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "goshawk/obstacle_tracker_lab/lab.hpp"

namespace goshawk::obstacle_tracker {
namespace {

using testing::HasSubstr;

const std::vector<Vec3> kSensor{Vec3(0, 0, 1)};

TEST(ObstacleTracker, ParametersOutOfRangeAreRefusedByName) {
  EXPECT_THAT(ObstacleTracker::create({.cell_m = 0.0}).error().message, HasSubstr("cell_m"));
  EXPECT_THAT(ObstacleTracker::create({.horizon_s = std::nan("")}).error().message,
              HasSubstr("horizon_s"));
  const Config huge{.range_m = 50.0, .height_m = 50.0, .cell_m = 0.1};
  EXPECT_THAT(ObstacleTracker::create(huge).error().message, HasSubstr("504 million cells"));
}

TEST(ObstacleTracker, ScansThatCannotBeAreRefusedAndChangeNothing) {
  auto tracker = ObstacleTracker::create({}).value();
  const std::vector<Vec3> points(3, Vec3(2, 0, 1));
  const std::vector<std::int64_t> times(2, 0);
  EXPECT_THAT(tracker.add({1, points, {}, {}}).error().message, HasSubstr("sensor's place"));
  EXPECT_THAT(tracker.add({1, points, kSensor, times}).error().message,
              HasSubstr("3 points but 2 times"));
  const std::vector<Vec3> nowhere{Vec3(std::nan(""), 0, 0)};
  EXPECT_THAT(tracker.add({1, points, nowhere, {}}).error().message, HasSubstr("not finite"));
  ASSERT_TRUE(tracker.add({1'000'000'000, points, kSensor, {}}));
  EXPECT_THAT(tracker.add({900'000'000, points, kSensor, {}}).error().message,
              HasSubstr("0.100 s older"));
  EXPECT_THAT(tracker.add({1'000'000'000, points, kSensor, {}}).error().message,
              HasSubstr("same stamp"));
  EXPECT_EQ(tracker.time_ns(), 1'000'000'000);
}

TEST(ObstacleTracker, PointsThatAreNotFiniteOrFarAwayAreLeftOut) {
  auto tracker = ObstacleTracker::create({}).value();
  const double inf = std::numeric_limits<double>::infinity();
  const std::vector<Vec3> points{Vec3(std::nan(""), 0, 0), Vec3(inf, 0, 0), Vec3(1e12, 0, 0),
                                 Vec3(0, 0, 1), Vec3(2, 0, 1)};
  for (int i = 1; i < 20; ++i) {
    ASSERT_TRUE(tracker.add({i * std::int64_t{100'000'000}, points, kSensor, {}}));
    EXPECT_TRUE(tracker.obstacles().empty());
  }
  ASSERT_TRUE(tracker.add({3'000'000'000, {}, kSensor, {}}));
}

/// A person before a wall, as rays of a coarse lidar see them; y of the person [m].
std::vector<Vec3> scene(double y) {
  std::vector<Vec3> points;
  for (int i = -60; i <= 60; ++i) {
    for (int k = -12; k <= 20; ++k) {
      const Vec3 direction = Vec3(1.0, 0.012 * i, 0.012 * k);
      const double at = 4.0 * direction.y() - y;
      const bool person = std::abs(at) < 0.25 && 4.0 * direction.z() < 0.8;
      points.push_back(kSensor[0] + (person ? 4.0 : 8.0) * direction);
    }
  }
  return points;
}

/// Walks at 1 m/s from y = -1.5 after a second of standing. @return obstacles after each scan
std::vector<std::vector<TrackedObstacle>> walk(ObstacleTracker& tracker, int scans) {
  std::vector<std::vector<TrackedObstacle>> told;
  for (int i = 0; i < scans; ++i) {
    const auto points = scene(-1.5 + 0.1 * std::max(0, i - 10));
    EXPECT_TRUE(tracker.add({1'000'000'000 + i * std::int64_t{100'000'000}, points, kSensor, {}}));
    told.emplace_back(tracker.obstacles().begin(), tracker.obstacles().end());
  }
  return told;
}

TEST(ObstacleTracker, WhatWalksIsToldWithItsVelocityAndWhatStandsIsNot) {
  auto tracker = ObstacleTracker::create({}).value();
  const auto told = walk(tracker, 36);
  for (int i = 0; i <= 10; ++i) EXPECT_TRUE(told[std::size_t(i)].empty());
  ASSERT_EQ(told.back().size(), 1u);
  const TrackedObstacle& o = told.back().front();
  EXPECT_NEAR(o.box.velocity_map.y(), 1.0, 0.25);
  EXPECT_NEAR(o.box.position_map.y(), 1.0, 0.3);
  EXPECT_TRUE(o.box.check());
  EXPECT_GT(o.bound_m, 0.0);
}

TEST(ObstacleTracker, TheSameScansGiveTheSameAnswers) {
  auto a = ObstacleTracker::create({}).value(), b = ObstacleTracker::create({}).value();
  const auto first = walk(a, 30), second = walk(b, 30);
  for (std::size_t i = 0; i < first.size(); ++i) {
    ASSERT_EQ(first[i].size(), second[i].size());
    for (std::size_t k = 0; k < first[i].size(); ++k) {
      EXPECT_EQ(first[i][k].box.position_map, second[i][k].box.position_map);
      EXPECT_EQ(first[i][k].box.id, second[i][k].box.id);
    }
  }
}

TEST(ObstacleTracker, WhatIsNotSeenAnyMoreIsForgottenAndItsBoundGrowsUntilThen) {
  auto tracker = ObstacleTracker::create({}).value();
  const auto told = walk(tracker, 36);
  ASSERT_EQ(told.back().size(), 1u);
  double bound = told.back().front().bound_m;
  const std::vector<Vec3> behind{Vec3(-3, 0, 1)};
  for (int i = 36; i < 46; ++i) {
    ASSERT_TRUE(tracker.add({1'000'000'000 + i * std::int64_t{100'000'000}, behind, kSensor, {}}));
    if (tracker.obstacles().empty()) break;
    EXPECT_GT(tracker.obstacles().front().bound_m, bound);
    bound = tracker.obstacles().front().bound_m;
  }
  ASSERT_TRUE(tracker.add({1'000'000'000 + 48 * std::int64_t{100'000'000}, behind, kSensor, {}}));
  EXPECT_TRUE(tracker.obstacles().empty());
}

TEST(ObstacleTracker, APauseOfTheSensorAndAResetForgetTracks) {
  auto tracker = ObstacleTracker::create({}).value();
  walk(tracker, 36);
  ASSERT_FALSE(tracker.obstacles().empty());
  ASSERT_TRUE(tracker.add({10'000'000'000, scene(1.0), kSensor, {}}));
  EXPECT_TRUE(tracker.obstacles().empty());
  walk(tracker, 0);
  tracker.reset();
  EXPECT_TRUE(tracker.obstacles().empty());
  EXPECT_EQ(walk(tracker, 36).back().size(), 1u);
}

}  // namespace
}  // namespace goshawk::obstacle_tracker
